/* made by hand for taylor-verify publish --site: tables that sort, filter and scroll by keyboard */
"use strict";

(function () {
  // A number with what may stand before and behind it: "<1e-3", "11.5, 7.42 @ 77", "1.26e-5 fail".
  const NUMBER = /^[<>~≈]?\s*([-+−]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)/i;
  const NOTHING = /^(?:–|-|—|)$/;
  // A table of fewer lines is seen at a glance, one of more is looked through with a filter.
  const SORTABLE = 6, FILTERABLE = 40;
  // A cell with more letters is read as a sentence, and needs the room of one.
  const SENTENCE = 40;

  function value(cell) {
    const text = cell.textContent.trim();
    if (NOTHING.test(text)) return null;
    if (text.startsWith("∞")) return Infinity;
    const found = NUMBER.exec(text);
    return found ? Number(found[1].replace("−", "-")) : NaN;
  }

  function isNumeric(cells) {
    const found = cells.map(value).filter(function (one) { return one !== null; });
    const numbers = found.filter(function (one) { return !Number.isNaN(one); });
    return numbers.length > found.length / 2;
  }

  // What is no number stands behind all numbers, whichever way they run.
  function byNumber(a, b, sign) {
    const one = value(a), other = value(b);
    const lost = [one, other].map(function (v) { return v === null || Number.isNaN(v); });
    if (lost[0] || lost[1]) return lost[0] - lost[1];
    return one === other ? 0 : sign * (one < other ? -1 : 1);
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
    table.querySelectorAll("th").forEach(function (one) { one.removeAttribute("aria-sort"); });
    heading.setAttribute("aria-sort", upwards ? "ascending" : "descending");
    body.append.apply(body, rows);
  }

  // A row that begins empty or in italics goes on with the row above: sorted, it would be nobody's.
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
      let seen = 0;
      rows.forEach(function (row, i) {
        row.hidden = !asked.every(function (word) { return texts[i].includes(word); });
        seen += row.hidden ? 0 : 1;
      });
      count.textContent = seen === rows.length ? rows.length + " rows" : seen + " of " + rows.length + " rows";
    }

    input.addEventListener("input", filter);
    filter();
  }

  // Only what scrolls is a stop for the keyboard; a fold that opens shows its table for the first time.
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
      cell.classList.toggle("sentence", cell.textContent.length > SENTENCE);
    });
  }

  document.addEventListener("DOMContentLoaded", function () {
    document.querySelectorAll("article table").forEach(function (table, number) {
      const rows = table.tHead && table.tBodies.length ? table.tBodies[0].rows.length : 0;
      table.id = table.id || "table-" + (number + 1);
      markSentences(table);
      if (rows >= SORTABLE && !hasGroups(table)) addSorting(table);
      if (rows >= FILTERABLE) addFilter(table, number + 1);
    });
    addStops();
    window.addEventListener("resize", addStops);
    document.addEventListener("toggle", addStops, true);
  });
})();
