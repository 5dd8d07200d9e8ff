"""Erratum L7: the mean of √K̃ of a chattering flock, which falls with the step."""


def test_the_chatter_falls_with_the_step(verdict_of):
    chatter = verdict_of("L7").claim("chatter").computed
    assert 0.06 < chatter[0] < 0.1  # √K̃ in the mean over time: from eight starts 0.075 to 0.086
    assert chatter[1] < 0.5 * chatter[0]
