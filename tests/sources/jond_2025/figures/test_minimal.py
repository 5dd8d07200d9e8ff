from flockana import scenario, simulate
from flockana.report.figures import flock_pictures, pictures


def test_the_profiles_come_last():
    entry = scenario("minimal-3d")
    run = simulate(entry.law, entry.q0, entry.p0, (0.0, 1.0))
    drawn = pictures(run)
    assert len(drawn) == len(flock_pictures(run)) + 1
    assert drawn[-1].caption.startswith("As in Fig. 10")
    assert drawn[-1].source.count("<svg") == 3
