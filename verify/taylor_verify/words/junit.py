"""Verdicts as JUnit XML, for Jenkins, GitLab and most others.

A run is a testsuite, each of its quantities a testcase. The file is green if and only if the exit status
is 0:

    pass                          nothing inside the testcase
    fail, regression              failure: the answer is wrong
    undecided, vacuous, refused   error: nothing was shown, which no reader may count as success;
                                  readers show a skipped case in green or not at all
    unavailable                   skipped: this machine has no such number type
    vacuous as --partial asks     skipped

If a baseline alone decides, a row that fails its own bound and is no regression is a pass here.

Both the schema of Surefire 3.0 and that of Jenkins (junit-10) admit it: the root is ``testsuites``
for the latter, each suite in it is one of the former.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Final
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.case import Case, Remark, cases

# An unlisted status is a KeyError, and never green.
_ELEMENTS: Final = {
    Status.PASS: "",
    Status.FAIL: "failure",
    Status.UNDECIDED: "error",
    Status.VACUOUS: "error",
    Status.REFUSED: "error",
}
_COUNTED: Final = {"failures": "failure", "errors": "error", "skipped": "skipped"}
_HEAD: Final = '<?xml version="1.0" encoding="UTF-8"?>'
# Characters that XML 1.0 cannot write, but that a program's stderr may hold.
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def junit(
    verdicts: Iterable[Verdict], remarks: Iterable[Remark] = (), by_remarks: bool = False
) -> str:
    """Return the document, which ends with a newline; ``by_remarks`` is as in `cases`."""
    # A row that vanished belongs to the suite of its run.
    runs: dict[tuple[str, ...], list[Case]] = {}
    for case in cases(verdicts, remarks, by_remarks):
        runs.setdefault((case.scene, case.solver, case.setting, case.rung), []).append(case)
    root = Element("testsuites", name="taylor-verify")
    root.extend([_suite(group) for group in runs.values()])
    for name in ("tests", "failures", "errors"):
        root.set(name, str(sum(int(suite.get(name, "0")) for suite in root)))
    ElementTree.indent(root)
    return f"{_HEAD}\n{ElementTree.tostring(root, encoding='unicode')}\n"


def _suite(group: Sequence[Case]) -> Element:
    some = group[0]
    name = " ".join(filter(None, (some.scene, some.rung, some.mark)))
    suite = Element("testsuite", name=_xml(name), tests=str(len(group)))
    elements = [_element(case) for case in group]
    for attribute, element in _COUNTED.items():
        suite.set(attribute, str(elements.count(element)))
    seconds = max((case.verdict.seconds or 0.0 for case in group if case.verdict), default=0.0)
    suite.set("time", _time(seconds))
    properties = SubElement(suite, "properties")
    for name, value in (("solver", some.solver), ("setting", some.setting), ("rung", some.rung)):
        SubElement(properties, "property", name=name, value=_xml(value))
    for case in group:
        # The solver ran once for all quantities: readers that add up the cases get its time once.
        suite.append(_testcase(case, seconds if case is some else 0.0))
    return suite


def _testcase(case: Case, seconds: float) -> Element:
    named = {"name": _xml(case.quantity), "classname": _xml(_classname(case))}
    element = Element("testcase", {**named, "time": _time(seconds)})
    if name := _element(case):
        inside = SubElement(element, name, message=_xml(case.text))
        if name != "skipped":  # A skipped case of Surefire has no type.
            inside.set("type", case.counted.value)
        inside.text = _xml(f"{case.title}\n{case.text}")
    return element


def _element(case: Case) -> str:
    return "skipped" if case.is_harmless else _ELEMENTS[case.counted]


def _classname(case: Case) -> str:
    """Return scene, rung and mark as a dotted name, which readers show as a tree."""
    parts = (*case.scene.removesuffix(".toml").split("/"), case.rung, *case.mark.split("/"))
    return ".".join(part.replace(".", "_") for part in parts if part.strip("."))


def _time(seconds: float) -> str:
    """Return a time in milliseconds for the schema of Surefire; 0 if it is not finite."""
    return f"{seconds:.3f}" if 0 <= seconds < float("inf") else "0.000"


def _xml(text: str) -> str:
    """Return the text with escapes for characters that XML cannot hold."""
    return _NOT_XML.sub(lambda match: f"\\x{ord(match[0]):02x}", text)
