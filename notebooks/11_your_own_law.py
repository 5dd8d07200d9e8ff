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
# # Your own law, verified end to end
#
# **Aims.** Add a law in one file, its theorem in a second and its proof in a third, and get integration, energy
# balance, verdict and certificate without writing any of them.
#
# The example is the law of Cucker and Smale (*IEEE TAC* 52(5), 2007), which has no potential at all:
#
# $$u_i = \sum_j a_{ij}(p_j - p_i), \qquad a_{ij} = \frac{s}{n}\,\bigl(1 + \|q_j - q_i\|^2\bigr)^{-\beta}.$$
#
# The three files are in `notebooks/own_law/`. In the package they would go to `flockana/laws/`, `flockana/theorems/`
# and `proofs/`, where they are found by themselves.

# %%
import sys
from pathlib import Path

import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import grade

sys.path.insert(0, str(Path.cwd().parent))  # the proofs live beside the package, not in it
from own_law.law import CuckerSmale

print(Path("own_law/law.py").read_text())

# %% [markdown]
# ## The law
#
# `flow` returns $u$ and, in closed form, the rate of what `hamiltonian` returns. That is a promise, and every run
# checks it: the rate is integrated beside the state.

# %%
rng = np.random.default_rng(0)
q0, p0 = rng.normal(0.0, 2.0, (30, 2)), rng.normal(0.0, 1.0, (30, 2))
run = fl.simulate(CuckerSmale(strength=1.0, decay=0.4), q0, p0, (0.0, 20.0))
print(run)
print(f"the balance closes to {abs(run.energy_residual).max() / run.energy()[0]:.1e} of K(0)")

# %% [markdown]
# ## The theorem
#
# While no pair is farther apart than $D$, every weight is at least $(s/n)(1+D^2)^{-\beta}$, and so
#
# $$\dot K = -\tfrac12\sum_{i,j} a_{ij}\|p_j-p_i\|^2 \le -2s\,(1+D^2)^{-\beta} K .$$

# %%
from own_law.theorem import THEOREM

print(fl.verify(THEOREM, run))

K, t = run.energy(), run.t
rate = fl.verify(THEOREM, run).claim("decay").stated
figure, ax = plots.subplots(size=(6, 3.2))
ax.semilogy(t, K, label="K, velocity mismatch")
ax.semilogy(t, K[0] * np.exp(-rate * t), label="the theorem's bound")
ax.set(xlabel="t (time)", ylabel="K (length²/time²)")
_ = ax.legend()

# %% [markdown]
# A verdict on a run is `numeric`: it says what this run did. For all runs there is the proof.
#
# ## The proof

# %%
from own_law.proof import PROOF

for step in PROOF.steps():
    print("✓" if step.holds else "✗", step.text)

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** Leave out the factor ½ in the rate that `flow` returns. What is the largest energy residual then, relative to
# $K(0)$? (Derive a class from `CuckerSmale` and override `flow`.) To the nearest integer.

# %% tags=["answer"]
residual = ...


# %% tags=["solution"]
class Wrong(CuckerSmale):
    def flow(self, t, q, p):
        u, rate = super().flow(t, q, p)
        return u, 2 * rate


wrong = fl.simulate(Wrong(), q0, p0, (0.0, 20.0))
residual = round(abs(wrong.energy_residual).max() / wrong.energy()[0])

# %% tags=["check"]
grade(residual, 1, hint="H(t) − H(0) − ∫ dH/dt tends to K(0) when the rate is doubled")

# %% [markdown] tags=["exercise"]
# **2.** Ask the theorem about a run of `paper-fragmentation`. What is the status?

# %% tags=["answer"]
status = ...

# %% tags=["solution"]
status = fl.verify(THEOREM, fl.scenario("paper-fragmentation").run()).status

# %% tags=["check"]
grade(status, "vacuous", hint="is it a run of this law?")

# %% [markdown] tags=["exercise"]
# **3.** For $\beta > \tfrac12$ a flock may disperse: $D$ grows without bound and so does the theorem's patience. Take
# two agents on a line, 1 apart, leaving each other at relative speed $w$, with $s = 1$, $\beta = 1$. The relative
# velocity obeys $\dot w = -w/(1+x^2)$, hence $w(t) = w(0) - \arctan x(t) + \arctan 1$. Above which $w(0)$ do they
# never match velocities?

# %% tags=["answer"]
escape = ...

# %% tags=["solution"]
escape = np.pi / 2 - np.arctan(1.0)

# %% tags=["check"]
grade(escape, np.pi / 4, rtol=1e-3, hint="w must not reach 0 as x → ∞")
