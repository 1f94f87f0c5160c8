"""The page on the paper's claims: how each is measured, what the data of Figure 2 say of it, and the page."""
