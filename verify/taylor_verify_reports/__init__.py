"""Publications of this project: claims of the source texts, studies, pages, pictures, site, paper.

    claims(*ids)    the ledger of both source texts, examined

This package calls the public functions of taylor_verify and adds its verbs, `publish` and `claims`, to the
command line as any plug-in would. taylor_verify imports nothing of it.
"""

from taylor_verify_reports.claims import claims

__all__ = ["claims"]
