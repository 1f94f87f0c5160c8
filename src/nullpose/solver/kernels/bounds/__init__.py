"""Upper bounds over boxes of poses, and the branch and bound that uses them."""
