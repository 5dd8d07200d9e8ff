from flockana.sources.su_2009.scenarios import informed_survey


def test_the_first_few_agents_know_the_leader():
    assert list(informed_survey(informed=6).law.gains.c1_gamma[5:7]) == [1.1, 0.0]
