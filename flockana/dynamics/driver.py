"""Loop that drives all runs: adaptive and fixed steps, compiled or not, laws with jumps, delayed laws, maps.

What differs is in the stepper: which steps it makes, and what ends one. Integrators are compiled with the law
(`flockana.dynamics.compiled`), interpreted (`flockana.dynamics.interpreted`), or go from switch to switch
(`flockana.dynamics.switches`); maps bring their own steps (`flockana.dynamics.iterate`).
"""

from collections.abc import Callable, Iterator

from flockana.dynamics.compiled import engine_of
from flockana.dynamics.frame import Plan
from flockana.dynamics.interpreted import Interpreter, VelocityInterpreter
from flockana.dynamics.sample import Samples, Start, Tally
from flockana.dynamics.stepper import Integrator, Stepper
from flockana.dynamics.switches import SwitchingInterpreter
from flockana.laws.law import Law
from flockana.laws.switched import SwitchedLaw
from flockana.laws.velocity import VelocityLaw


def drive(make_stepper: Callable[[], Stepper], tally: Tally) -> Iterator[Samples]:
    """Yield samples and steps of a run as they are computed."""
    stepper = make_stepper()
    tally.notes = stepper.notes
    if stepper.first is not None:
        yield stepper.first
    while not stepper.finished:
        count = stepper.advance()
        tally.evaluations, tally.steps = stepper.evaluations, tally.steps + count
        if count:
            yield from stepper.samples(count)
        if failure := stepper.describe_failure(tally.steps, count):
            tally.fail(failure)
            return
        stepper.continue_from(count)


def integrator_of(law: Law | VelocityLaw, start: Start, plan: Plan) -> Integrator:
    """Return the integrator of a law: compiled if possible, from switch to switch for laws with jumps."""
    if isinstance(law, VelocityLaw):
        return VelocityInterpreter(law, start, plan)
    if isinstance(law, SwitchedLaw) and law.located and plan.solver.dt is None:
        return SwitchingInterpreter(law, start, plan)
    return engine_of(law, start, plan) or Interpreter(law, start, plan)
