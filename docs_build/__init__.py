"""How the documentation is made: generated pages, formulas, links, and code blocks that run."""
