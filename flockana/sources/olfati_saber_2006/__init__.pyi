from .theorems.theorem_5_planar_nets import check as check
