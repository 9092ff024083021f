"""The paper: twelve pages at most that open with the findings, made of what the studies have stored."""
