# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The style of all plots. Import it before anything is drawn."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# Colours that colour-blind readers can distinguish.
BLUE, ORANGE, GREY, SKY, GREEN, PINK = "#0072B2", "#D55E00", "#666666", "#56B4E9", "#009E73", "#CC79A7"
DPI = 110
plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "svg.fonttype": "none",
                     "svg.hashsalt": "tetskin"})
