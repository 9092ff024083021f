"""The built site in a real browser: light and dark, wide and on a phone."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from taylor_verify.cli import main

pytestmark = pytest.mark.browser

WIDE, PHONE = (1280, 900), (390, 844)
LIGHT, DARK = "light", "dark"
# One of each kind; the whole site is walked through once, in `test_every_page_loads`.
KINDS = (
    "index.html",
    "docs/method.html",
    "docs/for/satellite.html",
    "docs/gallery/dzhanibekov.html",
    "docs/glossary.html",
    "docs/reference/calls.html",
    "reports/README.html",
    "reports/claims.html",
    "reports/scenes.html",
    "reports/scenes/euler-with-attitude.html",
    "reports/scenes/kirchhoff-whole-motion.html",
    "reports/reference/README.html",
    "reports/tables/controls.html",
    "reports/tables/tradeoff.html",
    "reports/upstream/traps.html",
)
SCENES = tuple(page for page in KINDS if page.startswith("reports/scenes/"))
SCENE = "reports/scenes/kirchhoff-whole-motion.html"
# What Chromium says of its own drawing by software; no fault of a page.
OF_THE_DRIVER = ("GL Driver Message", "Canvas2D", "GPU stall")
# A page takes a second; a machine that is busy, many.
PATIENCE = 60.0
# The number of colours on each canvas, of sixteen levels a channel.
COLOURS = """
return Array.from(document.querySelectorAll("canvas")).map(canvas => {
  if (!canvas.width || !canvas.height) return 0;
  const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  const seen = new Set();
  for (let i = 0; i < data.length; i += 4) seen.add([0, 1, 2, 3].map(k => data[i + k] >> 4).join());
  return seen.size;
});
"""
CONTRAST = """
const seen = [];
function channel(v) { v /= 255; return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; }
function luminance(c) { return 0.2126 * channel(c[0]) + 0.7152 * channel(c[1]) + 0.0722 * channel(c[2]); }
function parsed(text) { return text.match(/[\\d.]+/g).map(Number); }
function ground(element) {
  for (let one = element; one; one = one.parentElement) {
    const colour = parsed(getComputedStyle(one).backgroundColor);
    if (colour.length === 3 || colour[3] === 1) return colour;
  }
  return [255, 255, 255];
}
for (const element of document.querySelectorAll("body *:not(svg *):not(script):not(style)")) {
  const own = Array.from(element.childNodes).some(n => n.nodeType === 3 && n.textContent.trim());
  if (!own || element.closest("noscript")) continue;
  if (!element.getClientRects().length) continue;
  const one = luminance(parsed(getComputedStyle(element).color)), other = luminance(ground(element));
  const ratio = (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05);
  seen.push([ratio, element.tagName + "." + element.className + ": " + element.textContent.slice(0, 40)]);
}
return seen;
"""


class Reader:
    """Opens pages in one browser, with a width and a theme that the system asks for."""

    def __init__(self, driver: Any, site: Path) -> None:
        self.driver, self.site = driver, site

    def set(self, size: tuple[int, int] = WIDE, theme: str = LIGHT) -> None:
        width, height = size
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        # Without motion: what is scrolled to is there at once.
        features = [
            {"name": "prefers-color-scheme", "value": theme},
            {"name": "prefers-reduced-motion", "value": "reduce"},
        ]
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})

    def open(self, page: str) -> None:
        self.driver.get_log("browser")
        self.driver.get((self.site / page).as_uri())

    def complaints(self) -> list[str]:
        """Return the messages of the console since the page was opened, without the driver's own."""
        messages = [entry["message"] for entry in self.driver.get_log("browser")]
        return [text for text in messages if not any(word in text for word in OF_THE_DRIVER)]

    def run(self, script: str, *given: Any) -> Any:
        return self.driver.execute_script(script, *given)

    def until(self, holds: Callable[[], Any], what: str) -> Any:
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if result := holds():
                return result
            time.sleep(0.1)
        pytest.fail(f"expected {what} within {PATIENCE:g} s, got none @ {self.driver.current_url}")

    def look_into(self, index: int) -> list[int]:
        """Scroll to a motion, go into its page, and return the number of colours on each canvas there."""
        frame = self.driver.find_elements("css selector", ".turning iframe")[index]
        self.run(
            "arguments[0].scrollIntoView({behavior: 'instant', block: 'center'})",
            frame,
        )
        self.driver.switch_to.frame(frame)
        return self.until(lambda: [n for n in self.run(COLOURS) if n > 1], "a motion drawn")

    def look_at_motions(self) -> list[list[int]]:
        """Return the numbers of colours on the canvases of each motion of the page."""
        colours = []
        for index in range(self.run("return document.querySelectorAll('.turning iframe').length")):
            colours.append(self.look_into(index))
            self.driver.switch_to.default_content()
        return colours


@pytest.fixture
def reader(browser: Any, site: Path) -> Iterator[Reader]:
    opened = Reader(browser, site)
    opened.set()
    yield opened
    opened.open("index.html")
    opened.run("try { localStorage.clear(); } catch (none) {}")


def pages(site: Path) -> list[str]:
    return sorted(file.relative_to(site).as_posix() for file in site.rglob("*.html"))


def test_every_page_loads(reader: Reader, site: Path) -> None:
    """No page of the whole site has an error, a missing file or a warning in its console."""
    faults = {}
    for page in pages(site):
        reader.open(page)
        if complaints := reader.complaints():
            faults[page] = complaints
    assert faults == {}


@pytest.mark.parametrize(
    ("page", "theme"), [(page, (LIGHT, DARK)[n % 2]) for n, page in enumerate(KINDS)]
)
def test_a_phone_never_scrolls_sideways(reader: Reader, page: str, theme: str) -> None:
    """A page at 390 pixels with drawn pictures is no wider than the screen; its tables scroll within."""
    reader.set(PHONE, theme)
    reader.open(page)
    reader.look_at_motions()
    assert reader.run("return document.documentElement.scrollWidth") <= PHONE[0]
    assert reader.complaints() == []


@pytest.mark.parametrize("width", [1024, 1330, 1366, 1460, 1600])
def test_a_laptop_never_scrolls_sideways(reader: Reader, width: int) -> None:
    """A page beside its lists of pages and of headings is no wider than the window."""
    reader.set((width, 900))
    for page in KINDS:
        reader.open(page)
        assert reader.run("return document.documentElement.scrollWidth") <= width, page


CLASS = ["euler/tennis-racket", "loads/falling-plate", "loads/heavy-top", "loads/pd-wheels"]
DRAWN = "return document.querySelector('.body canvas').toDataURL()"


@pytest.mark.parametrize("scene", CLASS)
def test_a_page_for_a_class_turns_by_touch(reader: Reader, tmp_path: Path, scene: str) -> None:
    """On a phone a finger turns the body that `draw --animate` shows, and the page fits the screen."""
    out = tmp_path / "moving.html"
    assert main(["draw", scene, "--animate", "--out", str(out)]) == 0
    reader.set(PHONE)
    reader.driver.get(f"{out.as_uri()}#part=0.3")
    before = reader.run(DRAWN)
    for kind, points in (("Start", [150]), ("Move", [190]), ("Move", [240]), ("End", [])):
        touches = [{"x": x, "y": 240} for x in points]
        event = {"type": f"touch{kind}", "touchPoints": touches}
        reader.driver.execute_cdp_cmd("Input.dispatchTouchEvent", event)
    assert reader.run(DRAWN) != before
    assert reader.run("return document.documentElement.scrollWidth") <= PHONE[0]
    assert reader.complaints() == []


# Two of the four views of each page, by turns: what all pages share is seen in all four.
VIEWS = [((LIGHT, WIDE), (DARK, PHONE)), ((DARK, WIDE), (LIGHT, PHONE))]


@pytest.mark.parametrize(
    ("page", "theme", "size"),
    [(page, *view) for n, page in enumerate(KINDS) for view in VIEWS[n % 2]],
)
def test_text_can_be_read(reader: Reader, page: str, theme: str, size: tuple[int, int]) -> None:
    """All text has the contrast of 4.5 that WCAG 2.1 asks for (1.4.3), against what is behind it."""
    reader.set(size, theme)
    reader.open(page)
    contrasts = reader.run(CONTRAST)
    assert len(contrasts) > 10
    assert [text for ratio, text in contrasts if not ratio >= 4.5] == []


@pytest.mark.parametrize("size", [WIDE, PHONE], ids=["wide", "phone"])
@pytest.mark.parametrize("page", SCENES)
def test_a_scene_moves(reader: Reader, page: str, size: tuple[int, int]) -> None:
    """The page of a scene shows its body, the curve in it and the components in time, in colours."""
    reader.set(size)
    reader.open(page)
    (colours,) = reader.look_at_motions()
    assert len(colours) == 3
    assert min(colours) >= 5
    assert reader.complaints() == []


def column(reader: Reader, table: str, index: int) -> list[str]:
    rows: list[str] = reader.run(
        "return Array.from(document.querySelectorAll(arguments[0] + ' tbody tr'))"
        ".filter(row => !row.hidden).map(row => row.cells[arguments[1]].textContent.trim())",
        table,
        index,
    )
    return rows


def test_tables_sort_numbers_as_numbers(reader: Reader) -> None:
    """A click sorts 1e-5 above 2e-15, a second one turns it round, and aria-sort says which."""
    reader.open("reports/scenes.html")
    headings = [
        one.text.partition(" ")[0]
        for one in reader.driver.find_elements("css selector", "#table-1 thead th button")
    ]
    at = headings.index("f64")
    before = column(reader, "#table-1", at)
    button = reader.driver.find_elements("css selector", "#table-1 thead th button")[at]
    button.click()
    upwards = [float(text.split()[0]) for text in column(reader, "#table-1", at)]
    assert upwards == sorted(float(text.split()[0]) for text in before)
    assert upwards != [float(text.split()[0]) for text in before]
    heading = reader.driver.find_elements("css selector", "#table-1 thead th")[at]
    assert heading.get_attribute("aria-sort") == "ascending"
    button.click()
    downwards = [float(text.split()[0]) for text in column(reader, "#table-1", at)]
    assert downwards == upwards[::-1]
    assert heading.get_attribute("aria-sort") == "descending"
    names = column(reader, "#table-1", 0)
    reader.driver.find_elements("css selector", "#table-1 thead th button")[0].click()
    assert column(reader, "#table-1", 0) == sorted(names)


def test_tables_of_groups_stay_in_order(reader: Reader) -> None:
    """A table with rows that go on with the one above cannot be sorted; the others of its page can."""
    reader.open("reports/tables/tradeoff.html")
    goes_on = "tr:has(> td:first-child:empty), tr:has(> td:first-child > p > em:first-child)"
    grouped, plain = (
        reader.run(
            f"return Array.from(document.querySelectorAll('article table')).filter(t => "
            f"{sign}t.querySelector(arguments[0])).map(t => t.querySelectorAll('th button').length)",
            goes_on,
        )
        for sign in ("", "!")
    )
    assert len(grouped) >= 2
    assert not any(grouped)
    assert any(plain)


def test_the_big_table_can_be_searched(reader: Reader) -> None:
    """The filter leaves the rows that have every word, says how many, and gives all back."""
    reader.open("reports/tables/gates.html")
    every = column(reader, "#table-1", 0)
    box = reader.driver.find_element("css selector", "#filter-1")
    box.send_keys("kirchhoff f80")
    matching = column(reader, "#table-1", 0)
    assert matching
    assert len(matching) < len(every)
    assert all("kirchhoff" in name for name in matching)
    assert set(column(reader, "#table-1", 1)) == {"f80"}
    status = reader.driver.find_element("css selector", ".filter [role=status]").text
    assert status == f"{len(matching)} of {len(every)} rows"
    box.clear()
    box.send_keys(" ")
    assert column(reader, "#table-1", 0) == every


def test_the_keyboard_reaches_everything(reader: Reader) -> None:
    """Tab leads to the skip link first, then to the navigation, the theme and a table's headings."""
    from selenium.webdriver.common.keys import Keys

    reader.open("reports/scenes.html")
    body = reader.driver.find_element("css selector", "body")
    reached = []
    for _ in range(80):
        body.send_keys(
            Keys.TAB
        ) if not reached else reader.driver.switch_to.active_element.send_keys(Keys.TAB)
        reached.append(
            reader.run(
                """const one = document.activeElement;
                const edges = [one, one.nextElementSibling].filter(Boolean).map(e => getComputedStyle(e));
                return [one.className || one.id || one.tagName, one.closest("th") !== null,
                        edges.some(style => style.outlineStyle !== "none")]"""
            )
        )
    assert reached[0][0].startswith("skip-to-content")
    for part in ("sidebar-search", "theme-toggle", "filter-1"):
        assert any(name.startswith(part) for name, *_ in reached), part
    assert any("reference internal" in name for name, *_ in reached)
    assert sum(heading for _, heading, _ in reached) >= 3
    assert [name for name, _, outlined in reached if not outlined] == []
    reader.driver.switch_to.active_element.send_keys(Keys.ENTER)


def test_the_theme_is_kept(reader: Reader) -> None:
    """The button turns the page dark, motions too, and the next page is dark with it."""
    # A theme that is emulated would reach the page of the motion past the button.
    reader.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    reader.open(SCENE)
    paper = "return getComputedStyle(document.body).backgroundColor"
    light = reader.run(paper)
    reader.look_into(0)
    bright = reader.run(paper)
    reader.driver.switch_to.default_content()
    button = reader.driver.find_element("css selector", ".theme-toggle-content .theme-toggle")
    for _ in range(3):
        if reader.run(paper) == light:
            reader.run("arguments[0].click()", button)
    assert reader.run(paper) != light
    dark = reader.run(paper)
    reader.look_into(0)
    reader.until(lambda: reader.run(paper) != bright, "the motion on dark paper")
    reader.driver.switch_to.default_content()
    reader.open("docs/method.html")
    assert reader.run(paper) == dark


def test_the_search_finds_what_can_be_named(reader: Reader) -> None:
    """A verb, a key, a verdict, an error, a call and a scene are each found on their own page."""
    links = "return Array.from(document.querySelectorAll('#search-results li a')).map(a => a.href)"
    for word, place in {
        "sweep": "docs/sweeps.html",
        "mass_matrix": "docs/scenes.html",
        "vacuous": "docs/verdicts.html",
        "NotRepresentable": "docs/errors.html",
        "run_many": "docs/reference/calls.html",
        "polhode": "docs/glossary.html",
        "separatrix": "scenes/euler-separatrix.html",
        # A likely cause, in a long table.
        "dropped": "docs/verdicts.html",
    }.items():
        reader.driver.get(f"{(reader.site / 'search.html').as_uri()}?q={word}")
        reader.until(lambda at=place: at in "\n".join(reader.run(links)), f"{place} for {word}")
    assert reader.complaints() == []


def test_a_notebook_has_what_it_puts_out(reader: Reader) -> None:
    """Pictures of the gallery are drawn, each with its text, and the moving page has its body."""
    reader.open("docs/gallery/dzhanibekov.html")
    widths = reader.run(
        "return Array.from(document.querySelectorAll('article .cell_output img'))"
        ".map(image => [image.naturalWidth, image.alt.length])"
    )
    assert len(widths) == 2
    assert all(width > 300 and words > 60 for width, words in widths)
    assert [len(colours) for colours in reader.look_at_motions()] == [3]
    assert reader.complaints() == []


def test_formulas_are_set(reader: Reader) -> None:
    """Formulas of a scene have a size, and letters of other alphabets are no empty boxes."""
    reader.open(SCENE)
    sizes = reader.run(
        "return Array.from(document.querySelectorAll('math'))"
        ".map(m => [m.getBoundingClientRect().width, m.getBoundingClientRect().height])"
    )
    assert sizes
    assert all(width > 20 and height > 10 for width, height in sizes)


def test_exact_values_can_be_copied(reader: Reader) -> None:
    """The button puts the values into the clipboard and says so; they are plain text."""
    reader.open("reports/scenes/euler-with-attitude.html")
    button = reader.driver.find_element("css selector", "#exact button.copybtn")
    reader.run("arguments[0].scrollIntoView({behavior: 'instant', block: 'center'})", button)
    button.click()
    reader.until(
        lambda: button.get_attribute("data-tooltip") == "Copied!", "an answer of the button"
    )
    text = reader.driver.find_element("css selector", "#exact pre").text
    assert text.split()[0].startswith("t,")


def test_without_a_script_the_words_are_there(reader: Reader) -> None:
    """A scene without scripts still has its tables, its values, and a link to its motion."""
    reader.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    try:
        reader.open(SCENE)
        assert reader.driver.find_element("css selector", ".turning figcaption a").is_displayed()
        assert reader.driver.find_element("css selector", "#exact pre").text.split()[0] == "t,"
        assert reader.driver.find_elements("css selector", "table tbody tr")
    finally:
        reader.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})
