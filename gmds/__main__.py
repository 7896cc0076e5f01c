"""`python -m gmds`: the command line, where the `gmds` script is not on the path."""

from gmds.cli import main

if __name__ == "__main__":
    main()
