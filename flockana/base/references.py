"""One bibliography, and `cite`: the BibTeX of what an object rests on."""

from __future__ import annotations

from typing import Any

from flockana.base.errors import ArgumentError

BIBLIOGRAPHY = {
    "olfati-saber-2006": """@article{olfatisaber2006flocking,
  author  = {Olfati-Saber, Reza},
  title   = {Flocking for Multi-Agent Dynamic Systems: Algorithms and Theory},
  journal = {IEEE Transactions on Automatic Control},
  volume  = {51}, number = {3}, pages = {401--420}, year = {2006},
  doi     = {10.1109/TAC.2005.864190}
}""",
    "geschwender-2016": """@misc{geschwender2016slides,
  author       = {Geschwender, Daniel},
  title        = {Flocking for Multi-Agent Dynamic Systems: Algorithms and Theory (lecture slides on Olfati-Saber)},
  howpublished = {Lecture slides}, year = {2016}
}""",
    "isola-2024": """@misc{isola2024msn,
  author       = {Isola, Joey},
  title        = {Project 1: {MSN} Flocking Formation Control},
  howpublished = {Course project, CS 455}, year = {2024}
}""",
    "notebook-r2": """@misc{notebookr2,
  title        = {Flocking Algorithms in {$R^2$}},
  howpublished = {Student notebook comparing Algorithms 1 and 2 of Olfati-Saber}
}""",
    "harborth-1974": """@article{harborth1974problem,
  author  = {Harborth, Heiko},
  title   = {L{\\"o}sung zu Problem 664A},
  journal = {Elemente der Mathematik},
  volume  = {29}, pages = {14--15}, year = {1974}
}""",
    "jond-2025": """@misc{jond2025bearing,
  author        = {Jond, Hossein B.},
  title         = {Bearing-Distance Flocking with Zone-Based Interactions in Constrained Dynamic Environments},
  howpublished  = {Preprint, fifth version}, year = {2025},
  archiveprefix = {arXiv}, eprint = {2409.10047}
}""",
    "li-dead-zone": """@inproceedings{lideadzone,
  author = {Li, Yang and Yuan, Jin and Liu, Xuemei},
  title  = {A Flocking Algorithm for Second-Order Multi-Agent Systems},
  note   = {Conference paper; its theorem is stated without proof}
}""",
    "montanari-2025": """@article{montanari2025optimal,
  author  = {Montanari, Arthur N. and Barioni, Ana Elisa D. and Duan, Chao and Motter, Adilson E.},
  title   = {Optimal flock formation induced by agent heterogeneity},
  journal = {Nature Communications},
  volume  = {16}, year = {2025},
  doi     = {10.1038/s41467-025-64233-0}
}""",
    "flockana": """@software{flockana,
  author = {{The flockana developers}},
  title  = {flockana: control-theoretic analysis of flocking},
  year   = {2026}
}""",
}


def cite(item: Any) -> str:
    """Return the BibTeX entries that an object, or a key of the bibliography, rests on.

    A law or theorem of your own brings its entries itself: a reference that begins with @ is BibTeX as it stands.

    Parameters
    ----------
    item : str or object
        A key such as ``"olfati-saber-2006"``, or a theorem, scenario or law with a `references` attribute.

    Raises
    ------
    ArgumentError
        If nothing is known of it.

    Examples
    --------
    >>> cite("olfati-saber-2006").splitlines()[0]
    '@article{olfatisaber2006flocking,'
    """
    keys = (item,) if isinstance(item, str) else tuple(getattr(item, "references", ()))
    if not keys or any(key not in BIBLIOGRAPHY and not key.startswith("@") for key in keys):
        raise ArgumentError(
            f"nothing to cite for {item!r}: expected an object with references, or one of {', '.join(BIBLIOGRAPHY)}"
        )
    return "\n\n".join(BIBLIOGRAPHY.get(key, key) for key in keys)
