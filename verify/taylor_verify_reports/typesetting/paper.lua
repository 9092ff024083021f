-- What pandoc's own writers lack for a paper: columns of words to the left, and tables for journals.

local function aligned(element)
  for _, column in ipairs(element.colspecs) do
    if column[1] == "AlignDefault" then column[1] = "AlignLeft" end
  end
  return element
end

-- LaTeX: one float with a plain tabular, for pandoc writes a longtable, which two columns of text refuse.

local LETTERS = { AlignRight = "r", AlignCenter = "c", AlignLeft = "l" }

local ON_ONE_LINE = pandoc.WriterOptions { wrap_text = "none" }

local function inside(blocks)
  return (pandoc.write(pandoc.Pandoc(blocks), "latex", ON_ONE_LINE):gsub("%s+$", ""))
end

local function line(row)
  return table.concat(row.cells:map(function(cell) return inside(cell.contents) end), " & ") .. " \\\\"
end

local function float(element)
  local letters = element.colspecs:map(function(column) return LETTERS[column[1]] end)
  local parts = {
    "\\begin{table}[htbp]", "\\centering\\footnotesize", "\\caption{" .. inside(element.caption.long) .. "}",
    -- A table that is wider than the page is made smaller.
    "\\begin{adjustbox}{max width=\\linewidth}", "\\begin{tabular}{" .. table.concat(letters) .. "}", "\\toprule",
  }
  for _, row in ipairs(element.head.rows) do table.insert(parts, line(row)) end
  table.insert(parts, "\\midrule")
  for _, row in ipairs(element.bodies[1].body) do table.insert(parts, line(row)) end
  for _, last in ipairs { "\\bottomrule", "\\end{tabular}", "\\end{adjustbox}", "\\end{table}" } do
    table.insert(parts, last)
  end
  return pandoc.RawBlock("latex", table.concat(parts, "\n"))
end

function Table(element)
  return FORMAT == "latex" and float(aligned(element)) or aligned(element)
end
