"""The paper's Figure 2 and its poses, recomputed. Nothing else in the library knows them."""
