"""`python -m proofs` is `flockana prove`."""

from __future__ import annotations

import sys

from flockana.cli.main import main

if __name__ == "__main__":
    main(["prove", *sys.argv[1:]])
