"""The pages of accuracy by scene and rung."""
