"""The price of each option of a scene."""
