# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # σ-norm, bumps and pair potentials
#
# **Aims.** Build the potential that makes agents keep their distance, from its parts, and know which of its properties
# are proved, which are computed to what accuracy, and where a formula loses digits.
#
# Olfati-Saber (2006, section II) replaces the Euclidean norm, which has no gradient at zero, by
#
# $$\|z\|_\sigma = \frac{1}{\varepsilon}\left(\sqrt{1 + \varepsilon \|z\|^2} - 1\right), \qquad
#   \nabla \|z\|_\sigma = \frac{z}{\sqrt{1 + \varepsilon\|z\|^2}}.$$

# %%
import numpy as np
import sympy as sp

import flockana as fl
from flockana import plots, symbolic
from flockana.course import grade

alpha = fl.AlphaInteraction(d=7.0, r=8.4, eps=0.1, h=0.2, a=5.0, b=5.0)
x = np.linspace(0.0, 12.0, 400)
figure, axes = plots.subplots(1, 2)
axes[0].plot(x, alpha.sigma_norm(x), label="σ-norm, ε = 0.1")
axes[0].plot(x, x, label="Euclidean norm")
axes[0].set(xlabel="length", ylabel="norm")
axes[0].legend()
axes[1].plot(x / 12, alpha.bump(x / 12))
_ = axes[1].set(xlabel="z", ylabel="bump ρ_h(z), h = 0.2")

# %% [markdown]
# ## From action to potential
#
# The action of a pair is an uneven sigmoid, cut off by the bump,
#
# $$\begin{gathered}
#   \phi_\alpha(z) = \rho_h(z/r_\alpha)\,\phi(z - d_\alpha), \\[1ex]
#   \phi(s) = \tfrac12\left[(a+b)\,\sigma_1(s+c) + (a-b)\right], \qquad \sigma_1(s) = \frac{s}{\sqrt{1+s^2}},
# \end{gathered}$$
#
# with $c = |a-b|/\sqrt{4ab}$, so that $\phi(0) = 0$. Its integral from $d_\alpha$ is the potential $\psi_\alpha$. Let
# sympy derive it, step by step:

# %%
symbolic.derive_psi_alpha()

# %% [markdown]
# On the plateau of the bump there is a closed form; on the taper there is none, and the library integrates it to
# $10^{-13} c^*$. Over the distance of the two agents:

# %%
figure, axes = plots.subplots(1, 2)
plots.action(alpha, ax=axes[0])
plots.potential(alpha, ax=axes[1])
print(f"d_α = {alpha.d_alpha:.6f}, r_α = {alpha.r_alpha:.6f}, c* = ψ_α(0) = {alpha.c_star:.6f}")
print(f"ψ_α(r_α) = {alpha.psi_alpha(alpha.r_alpha):.6f}: what two agents out of range cost, each pair of them")

# %% [markdown]
# The attraction is a shallow well beside a high wall: pulling a pair apart costs $0.74$, pushing it together $52.4$. A
# student notebook on the same algorithm draws this curve over $z$ itself (its Fig. 3; here with the parameters of its
# first run, $a = 7$, $b = 9$, $h = 0.4$):

# %%
pair = fl.AlphaInteraction(d=1.9, r=2.8, eps=0.1, h=0.4, a=7.0, b=9.0)
z = np.linspace(0.0, 1.2 * pair.r_alpha, 500)
figure, ax = plots.subplots()
ax.plot(z, pair.psi_alpha(z))
_ = ax.set(xlabel="z = ‖q_j − q_i‖_σ", ylabel="ψ_α(z)")

# %% [markdown]
# ## Why not the deviation energy itself?
#
# A lattice is where the deviation energy $E(q)$, a mean of $(\|q_j - q_i\| - d)^2$ over the links, is zero. But $E$ is
# no potential to descend: it jumps where a pair comes into range, and has a corner where two agents coincide. The
# collective potential $V$, the sum of $\psi_\alpha$ over all pairs, has a continuous gradient at both
# (`python -m proofs deviation-energy`).

# %%
_ = plots.deviation(alpha)

# %% [markdown]
# ## Three routes to one number
#
# The compiled kernel, sympy's expression and plain quadrature compute it independently.

# %%
from scipy.integrate import quad

z = 5.0
paper = symbolic.AlphaSymbols(eps=0.1, h=0.2, a=5, b=5, d=7, r=8.4)
print(f"kernel      {alpha.psi_alpha(z):.13f}")
print(f"symbolic    {symbolic.psi_alpha(sp.Integer(5), alpha=paper).evalf(17):.13f}")
print(f"quadrature  {quad(alpha.phi_alpha, alpha.d_alpha, z, epsabs=0.0, epsrel=1e-13)[0]:.13f}")

# %% tags=["facts"]
exact = float(symbolic.psi_alpha(sp.Integer(5), alpha=paper).evalf(17))
assert abs(alpha.psi_alpha(z) - exact) < 1e-12
assert abs(quad(alpha.phi_alpha, alpha.d_alpha, z, epsabs=0.0, epsrel=1e-13)[0] - exact) < 1e-12

# %% [markdown]
# ## Digits that disappear
#
# For two agents $10^{-9}$ apart, $\sqrt{1+\varepsilon x^2}-1$ is a difference of equal numbers. The library computes
# $x^2/(\sqrt{1+\varepsilon x^2}+1)$, which is the same and loses nothing.

# %%
tiny = 1e-9
print(f"as printed {(np.sqrt(1 + 0.1 * tiny**2) - 1) / 0.1:.3e},  as computed {alpha.sigma_norm(tiny):.3e}")

# %% [markdown]
# ## Summary
#
# - The potential of a pair is the integral of its action; it has its minimum at $d$, a high wall at 0 and a shallow rim
#   at $r$.
# - On the bump's plateau it has a closed form, on the taper none.
# - Formulas that subtract nearly equal numbers lose digits; rearranged, they do not.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, derivation) For $a = 1$, $b = 5$: what is $c$, and what is $\phi(0)$ if $c$ is left out? Give the
# second number, exactly.

# %% tags=["answer"]
phi_at_zero = ...

# %% tags=["solution"]
phi_at_zero = 0.5 * ((1 + 5) * 0 + (1 - 5))

# %% tags=["check"]
grade(phi_at_zero, -2.0, hint="which term of φ is left at s = 0?")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, experiment) A lattice link costs nothing and a pair out of range costs $\psi_\alpha(r_\alpha)$.
# How many pairs out of range weigh as much as one coincident pair, for `alpha`? (Three significant digits.)

# %% tags=["answer"]
pairs = ...

# %% tags=["solution"]
pairs = alpha.c_star / alpha.psi_alpha(alpha.r_alpha)

# %% tags=["check"]
grade(pairs, 71.183219, digits=3, hint="both potentials are printed above")

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, reading) At $h = 1$ the bump is an indicator, which the slides call "still differentiable". Ask
# erratum E10 and give the height of the jump, exactly.

# %% tags=["answer"]
jump = ...

# %% tags=["solution"]
print(fl.verify("E10"))
jump = 1.0

# %% tags=["check"]
grade(jump, 1.0, hint="one-sided limits at z = 1")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, experiment) Where is the attraction strongest? Give the distance of the pair, to four significant
# digits.

# %% tags=["answer"]
strongest = ...

# %% tags=["solution"]
fine = np.linspace(alpha.d, alpha.r, 200_001)
strongest = fine[np.argmax(alpha.phi_alpha(alpha.sigma_norm(fine)))]

# %% tags=["check"]
grade(strongest, 7.3139591, digits=4, hint="maximise φ_α between d and r")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, derivation) Derive the stiffness of a link: what is $\phi_\alpha'(d_\alpha)$ for `alpha`? (Four
# significant digits; mind that $d_\alpha$ is on the taper of the bump.)

# %% tags=["answer"]
slope = ...

# %% tags=["solution"]
slope = 5.0 * 0.5 * (1.0 + np.cos(np.pi * (alpha.d_alpha / alpha.r_alpha - 0.2) / 0.8))  # φ(0) = 0 kills the other term

# %% tags=["check"]
grade(slope, 0.896325033, digits=4, hint="product rule; one of the two terms vanishes at d_α")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, design) Let $a = b$. Which value of $a$ makes a coincident pair cost $c^* = 1000$, with
# everything else as in `alpha`? (How does $\phi$ depend on $a = b$? Four significant digits.)

# %% tags=["answer"]
strength = ...

# %% tags=["solution"]
strength = 5.0 * 1000.0 / alpha.c_star  # with a = b, φ is a σ₁(s): all energies are proportional to a
print(fl.AlphaInteraction(d=7.0, r=8.4, eps=0.1, h=0.2, a=strength, b=strength).c_star)

# %% tags=["check"]
grade(strength, 95.449335, digits=4, hint="what is c for a = b, and what is left of φ?")

# %% [markdown] tags=["exercise"]
# **7.** ★★ (2 points, words) $n_{ij} = (q_j - q_i)/\sqrt{1 + \varepsilon\|q_j - q_i\|^2}$ is shorter than a unit
# vector. What does that do to the force between two agents that come very near each other, and what would go wrong with
# a unit vector in its place? In your own words, at least 30 of them. (The check counts words, and your lecturer reads
# the text.)

# %% tags=["answer"]
smoothness = ...

# %% tags=["solution"]
smoothness = """Where two agents coincide the vector is 0 and smooth, so the force on each falls to 0 there and the
law has a continuous derivative; solutions exist and are unique through a collision. A unit vector has no limit
where the agents coincide: it jumps when they pass through each other, the potential has a corner there, and the
right-hand side is not Lipschitz."""
# Rubric, a point each:
# the force vanishes smoothly at coincidence; a unit vector has no limit there, so that the
# law would be discontinuous.

# %% tags=["check"]
grade(smoothness, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")
