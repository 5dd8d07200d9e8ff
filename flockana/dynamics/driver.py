"""Loop that drives all runs: adaptive and fixed steps, compiled or not, laws with jumps, delayed laws, maps.

What differs is in the stepper: which steps it makes, and what ends one. Integrators are compiled with the law
(`flockana.dynamics.compiled_steps`), interpreted (`flockana.dynamics.interpreted_steps`), or go from switch to switch
(`flockana.dynamics.switch_location`); maps bring their own steps (`flockana.dynamics.map_stepper`).
"""

from collections.abc import Callable, Iterator

from flockana.dynamics.compiled_steps import engine_of
from flockana.dynamics.interpreted_steps import Interpreter, VelocityInterpreter
from flockana.dynamics.moving_frame import Plan
from flockana.dynamics.run_samples import Samples, Start, Tally
from flockana.dynamics.stepper import Integrator, Stepper
from flockana.dynamics.switch_location import SwitchingInterpreter
from flockana.laws.first_order_law import VelocityLaw
from flockana.laws.jump_laws import SwitchedLaw
from flockana.laws.law import Law


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
