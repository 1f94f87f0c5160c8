"""The paper replicated: its Figure 2, its poses, its claims. Nothing else in the library knows them."""
