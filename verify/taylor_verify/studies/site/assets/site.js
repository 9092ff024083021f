/* made by hand for taylor-verify publish --site: the theme, and what can be copied */
"use strict";

(function () {
  const root = document.documentElement;
  const system = window.matchMedia("(prefers-color-scheme: dark)");

  function isDark() {
    return root.dataset.theme ? root.dataset.theme === "dark" : system.matches;
  }

  function keep(theme) {
    // A page opened as a file may have no storage: the choice then holds for this page alone.
    try {
      localStorage.setItem("theme", theme);
    } catch (none) {
      return;
    }
  }

  function tell() {
    const button = document.getElementById("theme");
    button.textContent = isDark() ? "Light" : "Dark";
    button.setAttribute("aria-label", isDark() ? "Light theme" : "Dark theme");
    document.dispatchEvent(new CustomEvent("theme"));
  }

  function addToggle() {
    const button = document.getElementById("theme");
    button.hidden = false;
    button.addEventListener("click", function () {
      root.dataset.theme = isDark() ? "light" : "dark";
      keep(root.dataset.theme);
      tell();
    });
    system.addEventListener("change", tell);
    tell();
  }

  async function copy(text, button) {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = "Copied";
    } catch (refused) {
      button.textContent = "Select and copy";
    }
    setTimeout(function () { button.textContent = "Copy"; }, 2000);
  }

  function addCopy(pre) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = "Copy";
    button.setAttribute("aria-label", "Copy: " + pre.getAttribute("aria-label"));
    button.addEventListener("click", function () { copy(pre.textContent, button); });
    const line = document.createElement("div");
    line.className = "copy";
    line.append(button);
    pre.before(line);
  }

  addToggle();
  document.querySelectorAll("pre.copied").forEach(addCopy);
})();
