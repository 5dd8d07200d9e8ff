from collections import Counter

from flockana import DiscreteLaw, scenario, scenarios
from flockana.report.seed_surveys import Survey, surveys
from flockana.report.verify_catalogue import _execution_order, plan


def test_one_flow_is_begun_then_all_maps_then_the_others():
    tasks = (*plan(figures=False), *surveys(None, None))
    begun = _execution_order(tasks)
    assert Counter(begun) == Counter(tasks)
    subjects = [task.scenario if isinstance(task, Survey) else task.name for task in begun]
    maps = [name in scenarios() and isinstance(scenario(name).law, DiscreteLaw) for name in subjects]
    count = sum(maps)
    assert count > 100
    assert maps == [False] + [True] * count + [False] * (len(maps) - count - 1)
    assert begun[0] == tasks[0]
