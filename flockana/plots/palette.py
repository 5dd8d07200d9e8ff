"""Colours of all figures."""

from matplotlib.colors import LinearSegmentedColormap

# Okabe and Ito's colours, distinguishable with every common colour vision; always paired with a dash
BLUE, ORANGE, GREEN, VERMILLION, PURPLE = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7"
INK, MUTED, FAINT = "#222222", "#6b6b6b", "#d9d9d9"

# lightness rises from compressed to stretched, so that it reads in grey; the middle is grey, not white, so that
# a link at its desired length shows on paper
STRAIN = LinearSegmentedColormap.from_list("strain", ["#00356b", "#2f6fb0", "#8a8a8a", "#d98a2b", "#f5b83d"])
