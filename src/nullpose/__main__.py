"""Runs the command line as ``python -m nullpose``."""

from nullpose.cli.app import main

if __name__ == "__main__":
    main()
