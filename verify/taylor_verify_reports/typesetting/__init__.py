"""Mathematics and paper in their own formats: MathML, LaTeX, Typst."""
