"""Files that services read: each is what its service expects, and all tell the same facts."""

from __future__ import annotations

import importlib.util
import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

from taylor_verify.records.version import __version__

ROOT = Path(__file__).resolve().parents[2]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


def text_of(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def read(path: Path) -> Any:
    """A YAML file; the key `on` of a workflow is read as True by YAML 1.1."""
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def project() -> dict[str, Any]:
    return tomllib.loads(text_of("pyproject.toml"))


# What is said of the project.


def test_the_version_is_one() -> None:
    """The package, the citation, the archive, the recipe and the newest change say the same."""
    assert str(read(ROOT / "CITATION.cff")["version"]) == __version__
    assert json.loads(text_of(".zenodo.json"))["version"] == __version__
    assert read(ROOT / "recipe" / "recipe.yaml")["context"]["version"] == __version__
    assert f"\n## [{__version__}] - " in text_of("CHANGELOG.md")


def test_the_citation_is_one() -> None:
    """Names, licence, keywords and description agree in the citation, the archive and the package."""
    cited, stored = read(ROOT / "CITATION.cff"), json.loads(text_of(".zenodo.json"))
    required = {"cff-version", "message", "title", "authors", "version", "license", "abstract"}
    assert required <= set(cited)
    authors = [person["name"] for person in cited["authors"]]
    assert authors == [person["name"] for person in stored["creators"]]
    assert authors == [person["name"] for person in project()["project"]["authors"]]
    assert cited["license"] == stored["license"] == project()["project"]["license"]
    assert cited["keywords"] == stored["keywords"]
    assert f"<p>{cited['abstract'].strip()}</p>" == stored["description"]
    assert (cited["type"], stored["upload_type"]) == ("software", "software")
    assert all({"type", "title", "authors"} <= set(each) for each in cited["references"])


def test_the_classifiers_are_the_pythons_that_are_allowed() -> None:
    """requires-python, the classifiers and the workflow name the same versions."""
    metadata = project()["project"]
    low, high = re.fullmatch(r">=3\.(\d+),<3\.(\d+)", metadata["requires-python"]).groups()
    allowed = [f"3.{minor}" for minor in range(int(low), int(high))]
    named = [c.rpartition(" ")[2] for c in metadata["classifiers"] if ":: Python ::" in c]
    jobs = read(ROOT / ".github" / "workflows" / "check.yml")["jobs"]
    assert named == jobs["check"]["strategy"]["matrix"]["python"] == allowed


def test_links_of_the_readme_work_from_a_package_index() -> None:
    """Each relative link leads to the repository once there is an address; pictures are raw files."""
    spec = importlib.util.spec_from_file_location("readme", ROOT / "recipe" / "readme.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    readme = text_of("README.md")
    assert module.absolute(readme, "") == readme
    address = "https://example.org/blob/main"
    links = re.findall(r"\]\(([^()\s]+)\)", module.absolute(readme, address))
    assert {link.split("/")[3] for link in links} == {"blob", "raw"}
    assert all(link.startswith("https://example.org/") for link in links)
    assert project()["tool"]["hatch"]["metadata"]["hooks"]["custom"]["path"] == "recipe/readme.py"


# The pinned versions.


def pins(name: str) -> dict[str, str]:
    return dict(re.findall(r"^([\w.-]+)==(\S+)", text_of(name), re.MULTILINE))


def test_the_small_set_up_is_a_part_of_the_whole() -> None:
    """The libraries of `make verify` have the versions that `make test` adds to, and nothing else."""
    small, whole = pins("requirements-verify.txt"), pins("requirements.txt")
    assert {"heyoka", "numpy", "python-flint", "hatchling"} <= set(small)
    assert small.items() <= whole.items()
    assert len(small) < len(whole) / 4


def test_the_extra_of_the_second_package_is_that_group() -> None:
    """`reports` has what the site and the paper need, in the same versions; selenium is for tests alone."""
    project_table = project()["project"]["optional-dependencies"]
    group = project()["dependency-groups"]["publishing"]
    plots = project_table["plots"]
    assert sorted(project_table["reports"]) == sorted({*group, *plots} - {"selenium>=4.20"})


# The workflows.


@pytest.mark.parametrize("file", WORKFLOWS, ids=lambda file: file.stem)
def test_a_workflow_is_one(file: Path) -> None:
    """It has a trigger, the least permissions, and for every job a machine, a time limit and steps."""
    workflow = read(file)
    assert {"name", True, "permissions", "jobs"} <= set(workflow)
    assert workflow["permissions"] == {"contents": "read"}
    for job in workflow["jobs"].values():
        assert {"runs-on", "timeout-minutes", "steps"} <= set(job)
        assert all(("uses" in step) != ("run" in step) for step in job["steps"])


def test_every_command_of_make_in_a_workflow_exists() -> None:
    """A target that a workflow makes has a rule in the Makefile."""
    rules = set(re.findall(r"^([a-z-]+):", text_of("Makefile"), re.MULTILINE))
    named = {
        name for file in WORKFLOWS for name in re.findall(r"run: make ([a-z-]+)", file.read_text())
    }
    assert {"dist", "release-data"} <= named <= rules


def test_a_release_is_published_without_a_password() -> None:
    """PyPI trusts the workflow, by the one job that may ask for a token, and on a tag alone."""
    jobs = read(ROOT / ".github" / "workflows" / "release.yml")["jobs"]
    tokens = {name for name, job in jobs.items() if "id-token" in job.get("permissions", {})}
    assert tokens == {"pypi"}
    assert jobs["pypi"]["environment"] == "pypi"
    assert set(jobs["pypi"]["needs"]) == {"packages", "installed"}
    for name in ("pypi", "github"):
        assert jobs[name]["if"] == "startsWith(github.ref, 'refs/tags/')"
    assert "secrets." not in text_of(".github/workflows/release.yml")


# What other services read.


@pytest.mark.parametrize(
    "name", ["SECURITY.md", "CITATION.cff", ".zenodo.json", ".readthedocs.yaml"]
)
def test_no_address_is_invented(name: str) -> None:
    """No web address and no mail address; a DOI is of somebody else's article."""
    text = text_of(name)
    assert re.findall(r"https?://|[\w.]+@[\w-]+\.\w+", text) == []
    assert set(re.findall(r"10\.\d{4,}/\S+", text)) <= {"10.1093/mnras/stab1032"}


def test_the_hook_of_pre_commit_is_our_program() -> None:
    """It calls the console script, and hands it no names of changed files."""
    (hook,) = read(ROOT / ".pre-commit-hooks.yaml")
    assert hook["entry"] == hook["id"] == "taylor-verify"
    assert hook["language"] == "python"
    assert hook["pass_filenames"] is False
