"""The price of each thing that a scene may ask for."""
