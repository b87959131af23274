"""The manual: its pages in Markdown, what is written of the code's own declarations, and the site made of both."""
