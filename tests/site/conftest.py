"""Tests in a browser: part of no run but the one that asks for them, which fails without a browser."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

SITE = Path(__file__).resolve().parents[2] / "reports" / "site"
_OPTIONS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--hide-scrollbars",
    "--disable-dev-shm-usage",
    "--no-first-run",
)


def pytest_ignore_collect(config: pytest.Config) -> bool | None:
    """Collect these tests only where `-m` names them."""
    return None if "browser" in config.getoption("-m") else True


@pytest.fixture(scope="session")
def site() -> Path:
    assert (SITE / "index.html").exists(), "expected a built site, got none; run `make test-site`"
    return SITE


@pytest.fixture(scope="session")
def browser(site: Path) -> Iterator[Any]:
    """A Chromium without a window, its console logged from the first line on."""
    from selenium import webdriver

    programs = {name: shutil.which(name) for name in ("chromium", "chromedriver")}
    assert all(programs.values()), f"expected chromium and its driver, got {programs}"
    options = webdriver.ChromeOptions()
    options.binary_location = str(programs["chromium"])
    for option in _OPTIONS:
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    service = webdriver.ChromeService(str(programs["chromedriver"]))
    driver = webdriver.Chrome(options=options, service=service)
    try:
        yield driver
    finally:
        driver.quit()
