"""`python -m flockana`: the command line."""

from flockana.cli.main import main

if __name__ == "__main__":
    main()
