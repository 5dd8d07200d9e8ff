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
# # A first flock in five minutes
#
# **Aims.** Run a published simulation, see how far its numbers can be trusted, and ask a theorem about it.
#
# Each agent is a double integrator, $\dot q_i = p_i$, $\dot p_i = u_i$. Olfati-Saber's Algorithm 2 steers it by its
# neighbours within a range $r$ and by a γ-agent $(q_r, p_r)$ (*IEEE TAC* 51(3), 2006):
#
# $$u_i = c_1^\alpha \sum_{j \in N_i} \phi_\alpha(\|q_j - q_i\|_\sigma)\, n_{ij}
#       + c_2^\alpha \sum_{j \in N_i} a_{ij}(q)\,(p_j - p_i)
#       - c_1^\gamma (q_i - q_r) - c_2^\gamma (p_i - p_r).$$

# %%
import flockana as fl
from flockana import plots
from flockana.course import grade

case = fl.scenario("paper-flocking")
print(case.title)
print(case.source)

# %% [markdown]
# ## Run it
#
# The integrator carries $\int \dot H\,dt$ beside the state. What is left of $H(t) - H(0) - \int_0^t \dot H\,dt$ is the
# error that it made.

# %%
run = case.run()
print(f"{run.n} agents, {run.stats['steps']} steps in {run.stats['seconds']:.1f} s")
print(f"energy falls from {run.energy()[0]:.4g} to {run.energy()[-1]:.4g}")
print(f"the balance is off by {abs(run.energy_residual).max():.1g} at most")

# %%
figure, axes = plots.subplots(1, 2, size=(11, 5))
plots.snapshot(run, time=run.t[0], ax=axes[0])
_ = plots.snapshot(run, time=run.t[-1], ax=axes[1])

# %% [markdown]
# ## Ask a theorem
#
# Theorem 3 promises cohesion, a local minimum of $U_\lambda = V + \lambda J$ as the limit, matched velocities, and few
# collisions. A verdict lists its hypotheses first: one that fails makes a claim *vacuous*, not true.

# %%
print(fl.verify("os-3", run))

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** Run the scenario `collapse` and ask erratum E11 about it. What is the status of the verdict?

# %% tags=["answer"]
collapse_status = ...

# %% tags=["solution"]
collapse = fl.scenario("collapse").run()
collapse_status = fl.verify("E11", collapse).status
_ = plots.snapshot(collapse)
# %% tags=["check"]
grade(collapse_status, "refuted", hint="fl.verify(name, run).status, one word")

# %% [markdown] tags=["exercise"]
# **2.** Ask Theorem 1 (`os-1`) about a run of `paper-fragmentation`. It is vacuous: at what time does the run itself
# break a hypothesis for the first time? (Two digits.)

# %% tags=["answer"]
broken_at = ...

# %% tags=["solution"]
fragments = fl.scenario("paper-fragmentation").run()
print(fl.verify("os-1", fragments))
broken_at = 0.21

# %% tags=["check"]
grade(broken_at, lambda t: 0.205 < t < 0.22, hint="read the line that says what this run is not")

# %% [markdown] tags=["exercise"]
# **3.** scipy would have integrated with `rtol=1e-3` and `atol=1e-6`, had we not asked for better. By what factor does
# the largest energy residual of `case` grow at those tolerances?

# %% tags=["answer"]
factor = ...

# %% tags=["solution"]
loose = fl.simulate(case.law, case.q0, case.p0, case.t_span, rtol=1e-3, atol=1e-6)
factor = abs(loose.energy_residual).max() / abs(run.energy_residual).max()
print(f"{factor:.0f} times")

# %% tags=["check"]
grade(factor, lambda x: 1e3 < x < 1e5, hint="fl.simulate(case.law, ...), then abs(run.energy_residual).max()")
