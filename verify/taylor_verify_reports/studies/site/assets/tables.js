/* made by hand for taylor-verify publish --site: tables that sort, filter and scroll by keyboard */
"use strict";

(function () {
  // A number, with other text before or after it: "<1e-3", "11.5, 7.42 @ 77", "1.26e-5 fail".
  const NUMBER = /^[<>~≈]?\s*([-+−]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)/i;
  const NOTHING = /^(?:–|-|—|)$/;
  // Tables with fewer rows need no sorting. Tables with more rows than the second number get a filter.
  const SORTABLE = 6, FILTERABLE = 40;
  // A cell with more letters is a sentence, or a phrase, and needs a wide column, or a less narrow one.
  const SENTENCE = 40, PHRASE = 18;

  function value(cell) {
    const text = cell.textContent.trim();
    if (NOTHING.test(text)) return null;
    if (text.startsWith("∞")) return Infinity;
    const match = NUMBER.exec(text);
    return match ? Number(match[1].replace("−", "-")) : NaN;
  }

  function isNumeric(cells) {
    const filled = cells.map(value).filter(function (entry) { return entry !== null; });
    const numbers = filled.filter(function (entry) { return !Number.isNaN(entry); });
    return numbers.length > filled.length / 2;
  }

  // Cells without a number come last in both directions.
  function byNumber(a, b, sign) {
    const first = value(a), second = value(b);
    const isWord = [first, second].map(function (v) { return v === null || Number.isNaN(v); });
    if (isWord[0] || isWord[1]) return isWord[0] - isWord[1];
    return first === second ? 0 : sign * (first < second ? -1 : 1);
  }

  const words = new Intl.Collator("en", { numeric: true });

  function byWord(a, b, sign) {
    return sign * words.compare(a.textContent.trim(), b.textContent.trim());
  }

  function sort(table, heading, index) {
    const body = table.tBodies[0];
    const rows = Array.from(body.rows);
    const upwards = heading.getAttribute("aria-sort") !== "ascending";
    const compare = isNumeric(rows.map(function (row) { return row.cells[index]; })) ? byNumber : byWord;
    rows.sort(function (a, b) { return compare(a.cells[index], b.cells[index], upwards ? 1 : -1); });
    table.querySelectorAll("th").forEach(function (other) { other.removeAttribute("aria-sort"); });
    heading.setAttribute("aria-sort", upwards ? "ascending" : "descending");
    body.append.apply(body, rows);
  }

  // A row that begins empty or in italics belongs to the row above, so that its table must not be sorted.
  function hasGroups(table) {
    return Array.from(table.tBodies[0].rows).some(function (row) {
      return !row.cells[0].textContent.trim() || row.cells[0].querySelector(":scope > p > em:first-child");
    });
  }

  function addSorting(table) {
    Array.from(table.tHead.rows[0].cells).forEach(function (heading, index) {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...heading.childNodes);
      heading.append(button);
      button.addEventListener("click", function () { sort(table, heading, index); });
    });
  }

  function addFilter(table, number) {
    const rows = Array.from(table.tBodies[0].rows);
    const texts = rows.map(function (row) { return row.textContent.toLowerCase().replace(/\s+/g, " "); });
    const line = document.createElement("p"), label = document.createElement("label");
    const input = document.createElement("input"), count = document.createElement("span");
    line.className = "filter";
    label.textContent = "Filter";
    label.htmlFor = input.id = "filter-" + number;
    input.type = "search";
    input.autocomplete = "off";
    count.setAttribute("role", "status");
    line.append(label, input, count);
    (table.closest(".table-wrapper") || table).before(line);

    function filter() {
      const asked = input.value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      rows.forEach(function (row, i) {
        row.hidden = !asked.every(function (word) { return texts[i].includes(word); });
        shown += row.hidden ? 0 : 1;
      });
      count.textContent = shown === rows.length ? rows.length + " rows" : shown + " of " + rows.length + " rows";
    }

    input.addEventListener("input", filter);
    filter();
  }

  // Only a box that scrolls gets the focus of the keyboard. Boxes are measured again when a fold opens, because
  // a hidden table has no width.
  function addStops() {
    document.querySelectorAll(".table-wrapper, .formula").forEach(function (box) {
      if (box.scrollWidth > box.clientWidth) {
        box.tabIndex = 0;
        box.setAttribute("role", "region");
        box.setAttribute("aria-label", (box.closest("section") || document).querySelector("h1, h2, h3, h4").firstChild.textContent);
      } else {
        box.removeAttribute("tabindex");
        box.removeAttribute("role");
        box.removeAttribute("aria-label");
      }
    });
  }

  function markSentences(table) {
    table.querySelectorAll("td:not(.text-right)").forEach(function (cell) {
      const letters = cell.textContent.length;
      cell.classList.toggle("sentence", letters > SENTENCE);
      cell.classList.toggle("phrase", letters > PHRASE && letters <= SENTENCE);
    });
  }

  // A column of words in which no row has any takes the room of the others.
  function hideEmptyColumns(table) {
    const rows = Array.from(table.tBodies[0].rows);
    Array.from(table.tHead.rows[0].cells).forEach(function (heading, index) {
      const column = rows.map(function (row) { return row.cells[index]; });
      const isEmpty = column.every(function (cell) { return cell && NOTHING.test(cell.textContent.trim()); });
      if (!isEmpty || heading.classList.contains("text-right")) return;
      [heading, ...column].forEach(function (cell) { cell.hidden = true; });
    });
  }

  document.addEventListener("DOMContentLoaded", function () {
    document.querySelectorAll("article table").forEach(function (table, number) {
      const rows = table.tHead && table.tBodies.length ? table.tBodies[0].rows.length : 0;
      table.id = table.id || "table-" + (number + 1);
      markSentences(table);
      if (rows > 1) hideEmptyColumns(table);
      if (rows >= SORTABLE && !hasGroups(table)) addSorting(table);
      if (rows >= FILTERABLE) addFilter(table, number + 1);
    });
    addStops();
    window.addEventListener("resize", addStops);
    document.addEventListener("toggle", addStops, true);
  });
})();
