"""The paper: at most twelve pages that open with the findings, made from the stored studies."""
