"""From a scenario to numbers: ratios, their domain, the axes of each scheme."""
