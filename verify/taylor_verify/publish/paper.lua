-- What pandoc's own writers lack for a published page: tables that fit a printed page, signs that
-- pdflatex does not know, code that can break at the end of a line, and links among the renderings.
-- `taylor_verify.publish.paper` runs it; the metadata `folder` and `pages` come from there.

local latex = FORMAT == "latex"
local stringify = pandoc.utils.stringify

local function raw(text) return pandoc.RawInline("latex", text) end
local function raw_block(text) return pandoc.RawBlock("latex", text) end

-- HTML in a page would be lost in LaTeX. A comment is seen by nobody anyway.

local function refuse_html(element)
  if not element.text:match("^%s*<!%-%-.*%-%->%s*$") then
    error("expected no HTML, got " .. element.text, 0)
  end
  return {}
end

-- Formulas: the words of a \text outside every brace become words of the page, which can break.

local function depth(tex)
  local plain = tex:gsub("\\[{}]", ""):gsub("\\left%f[%A]", "{"):gsub("\\right%f[%A]", "}")
  return select(2, plain:gsub("{", "")) - select(2, plain:gsub("}", ""))
end

local function formula(tex)
  local before, inner, behind = tex:match("^(%s*)(.-)(%s*)$")
  local parts = pandoc.Inlines(before == "" and {} or { pandoc.Space() })
  if inner ~= "" then
    -- In the style of a line, fractions are too small to be read.
    local tall = inner:find("frac", 1, true) or inner:find("\\int", 1, true)
    parts:insert(pandoc.Math("InlineMath", (tall and "\\displaystyle " or "") .. inner))
    if behind ~= "" then parts:insert(pandoc.Space()) end
  end
  return parts
end

local function break_formula(math)
  local parts, pending, rest = pandoc.Inlines {}, "", math.text
  while true do
    local head, words, tail = rest:match("^(.-)\\text(%b{})(.*)$")
    if not head then return parts .. formula(pending .. rest) end
    pending, rest = pending .. head, tail
    if depth(pending) == 0 then
      parts = parts .. formula(pending) .. pandoc.Inlines(words:sub(2, -2))
      pending = ""
    else
      pending = pending .. "\\text" .. words
    end
  end
end

-- Signs: pandoc's reader of MathML knows the macro of nearly every one of mathematics.

-- Beyond these letters the encoding T1 has no sign but dashes, quotation marks and an ellipsis.
local LAST_LATIN, FIRST_DASH, ELLIPSIS = 0x17F, 0x2010, 0x2026
local RAISED = { ["⁻"] = "^{-}", ["ᵀ"] = "^{\\mathsf T}", ["″"] = "''", ["⁺"] = "^{+}" }
for digit = 0, 9 do
  RAISED[utf8.char(0x2070 + digit)] = "^{" .. digit .. "}"
  RAISED[utf8.char(0x2080 + digit)] = "_{" .. digit .. "}"
end

local function macro(code_point)
  local sign = utf8.char(code_point)
  if RAISED[sign] then return pandoc.Math("InlineMath", RAISED[sign]) end
  local math = pandoc.read("<math><mi>" .. sign .. "</mi></math>", "html").blocks[1].content[1]
  if math and math.t == "Math" and not math.text:find("[\x80-\xff]") then return math end
  return pandoc.Str(("[U+%04X]"):format(code_point))
end

-- `make` is pandoc.Str or pandoc.Code: what the signs between two macros are set in.
local function spell(text, make)
  local parts, plain = pandoc.Inlines {}, ""
  for _, code_point in utf8.codes(text) do
    if code_point <= LAST_LATIN or (FIRST_DASH <= code_point and code_point <= ELLIPSIS) then
      plain = plain .. utf8.char(code_point)
    else
      if plain ~= "" then parts:insert(make(plain)) end
      parts:insert(macro(code_point))
      plain = ""
    end
  end
  if plain ~= "" then parts:insert(make(plain)) end
  return parts
end

-- Code: a long name can go on in the next line behind one of these.

local function break_points(text)
  return (text:gsub("([/,;:=?.%-)%]}])(%f[%w({\\])", "%1\0%2"):gsub("(%l)_(%f[%w])", "%1_\0%2"))
end

local function break_code(code)
  local parts = pandoc.Inlines {}
  for piece in (break_points(code.text) .. "\0"):gmatch("(%Z*)%z") do
    if #parts > 0 then parts:insert(raw("\\allowbreak{}")) end
    parts = parts .. spell(piece, pandoc.Code)
  end
  return parts
end

-- Tables: the width of every column is estimated, from above, for the first page and type that do.

-- A4 with margins of 20 mm, upright and turned by 90 degrees; in points, as all that follows.
local UPRIGHT, TURNED = 483, 731
local SIZES, GAP = { 8, 7 }, 8
-- A column of words gets at least so many digits where it is broken.
local LEAST = 18

-- The width of a text in ems of type as small as here.
local function ems(text)
  local wide = select(2, text:gsub("[%umw%%@]", ""))
  local foreign = select(2, text:gsub("[\xc2-\xf4]", ""))
  return 0.62 * (utf8.len(text) - wide - foreign) + 0.9 * wide + 1.05 * foreign
end

local function longest_word(cell)
  local broken = cell:walk { Code = function(c) return pandoc.Str((break_points(c.text):gsub("%z", " "))) end }
  local longest = 0
  for word in stringify(broken):gmatch("%S+") do longest = math.max(longest, ems(word)) end
  return longest
end

-- For each column what it takes if nothing in it is broken, and what it takes at least.
local function measure(rows, heads, aligned)
  local full, least = {}, {}
  for i, head in ipairs(heads) do
    full[i], least[i] = longest_word(head.contents), longest_word(head.contents)
    for _, row in ipairs(rows) do
      full[i] = math.max(full[i], ems(stringify(row.cells[i].contents)))
      least[i] = math.max(least[i], longest_word(row.cells[i].contents))
    end
    -- A number of two parts stays on one line; words are broken where that gains something.
    if aligned[i][1] ~= "AlignRight" then least[i] = math.max(least[i], math.min(full[i], LEAST * 0.62)) end
  end
  return full, least
end

local function total(list)
  local sum = 0
  for _, number in ipairs(list) do sum = sum + number end
  return sum
end

-- The page and the size of type, in the order of what is easiest to read.
local function choose(full, least)
  local gaps = GAP * #full
  for _, room in ipairs { UPRIGHT, TURNED } do
    for _, wanted in ipairs { full, least } do
      for _, size in ipairs(SIZES) do
        if total(wanted) * size + gaps <= room then return room, size end
      end
    end
  end
  return TURNED, (TURNED - gaps) / total(least)
end

local function fit(element)
  local rows = element.bodies:map(function(body) return body.body end)[1] or {}
  local full, least = measure(rows, element.head.rows[1].cells, element.colspecs)
  local room, size = choose(full, least)
  local ample = room - GAP * #full
  -- In proportion to the root of the length: the longest column is not all that is read.
  local spare, wishes = ample / size - total(least), {}
  for i = 1, #full do wishes[i] = math.sqrt(full[i] - least[i]) end
  local share = spare / math.max(total(wishes), 1e-9)
  for i, specification in ipairs(element.colspecs) do
    local width = math.min(full[i], least[i] + share * wishes[i])
    element.colspecs[i] = { specification[1], math.floor(width * size / ample * 1e4) / 1e4 }
  end
  return room == TURNED, ("\\fontsize{%.2f}{%.2f}\\selectfont\\setlength{\\tabcolsep}{%dpt}"):format(
    size, 1.2 * size, GAP // 2), element
end

-- A heading that stayed on the page before a turned table would stand on it alone.
local function lay_out(blocks)
  local laid = pandoc.Blocks {}
  for _, block in ipairs(blocks) do
    if block.t == "Table" then
      local turned, type_size, fitted = fit(block)
      local heading = turned and #laid > 0 and laid[#laid].t == "Header" and laid:remove() or nil
      if turned then laid:insert(raw_block("\\begin{landscape}")) end
      if heading then laid:insert(heading) end
      laid:extend { raw_block("{" .. type_size), fitted, raw_block("}") }
      if turned then laid:insert(raw_block("\\end{landscape}")) end
    elseif block.t == "CodeBlock" then
      laid:extend { raw_block("{\\footnotesize"), block, raw_block("}") }
    else
      laid:insert(block)
    end
  end
  return laid
end

-- Links and pictures: all renderings stand in one folder, a page in it or above it.

local IN_THE_WEB = "^%a[%w+.-]*:"

local function seen_from_renderings(address, meta)
  if address:match(IN_THE_WEB) or address:match("^#") then return address end
  local joined = (stringify(meta.folder) .. address):gsub("^%.%./tables/", "")
  local path, anchor = joined:match("^([^#]*)(.*)$")
  if (" " .. stringify(meta.pages) .. " "):find(" " .. path .. " ", 1, true) then
    path = path:match("([^/]*)%.md$") .. ".html"
  end
  return path .. anchor
end

-- A file beside the page is not beside a printed one.
local function print_link(link)
  return link.target:match("://") and link or link.content
end

-- LaTeX takes the PDF of a picture, and goes without where there is none.
local function print_picture(image)
  local file = image.src:gsub("%.%a+$", ".pdf")
  return raw(("\\IfFileExists{%s}{\\includegraphics[width=\\linewidth,height=.8\\textheight,keepaspectratio]"
    .. "{%s}}{}"):format(file, file))
end

function Pandoc(page)
  page = page:walk { RawInline = refuse_html, RawBlock = refuse_html, Math = break_formula }
  for _, block in ipairs(page.blocks) do
    if block.t == "Header" then page.meta.pagetitle = stringify(block) break end
  end
  if not latex then
    return page:walk {
      Link = function(link) link.target = seen_from_renderings(link.target, page.meta) return link end,
      Image = function(image) image.src = seen_from_renderings(image.src, page.meta) return image end,
    }
  end
  page.blocks = lay_out(page.blocks)
  return page:walk {
    Link = print_link,
    Image = print_picture,
    Code = break_code,
    -- An apostrophe is what it is in a book; in code it stays straight.
    Str = function(words) return spell((words.text:gsub("'", "\u{2019}")), pandoc.Str) end,
  }
end
