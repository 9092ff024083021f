"""Sphinx settings of every page: theme, Markdown, formulas and scripts; docs/conf.py adds its own."""

from __future__ import annotations

from pathlib import Path

from taylor_verify.records.version import __version__

project = "taylor-verify"
author = "The taylor-verify authors"
version = release = __version__

# myst_nb reads notebooks in Markdown, and other Markdown as MyST's parser does.
extensions = ["myst_nb", "sphinx_copybutton", "taylor_verify_reports.studies.site.extension"]
exclude_patterns = ["_build"]
# As on GitHub: formulas stand between dollars, and headings have anchors made from their words.
myst_enable_extensions = ["deflist", "dollarmath", "fieldlist"]
myst_heading_anchors = 4
# Notebooks are executed with each build, so that their output is never outdated. Sphinx warns of an error
# in a cell.
nb_execution_mode = "force"
nb_execution_in_temp = nb_execution_show_tb = nb_merge_streams = True
nb_execution_timeout = 300
nb_output_stderr = "error"
# Blocks without a language are plain text, so that no lexer warns of them.
highlight_language = "text"
# The quotation marks of pages stay as written.
smartquotes = False

html_theme = "furo"
html_title = project
html_math_renderer = "mathml"
html_static_path = [str(Path(__file__).parent / "assets")]
html_css_files = ["site.css"]
html_js_files = ["tables.js"]
html_show_copyright = False
html_show_sourcelink = False
html_copy_source = False
html_domain_indices = html_use_index = False
# Search results have no excerpts, because a page that is opened as a file cannot read other pages.
html_show_search_summary = False
pygments_style = "default"
pygments_dark_style = "monokai"
# Only commands are copied, without prompts and output.
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True
