"""What a proof says of its steps."""


def failing(steps):
    """Texts of those that do not hold, or of which the machine cannot tell."""
    return [step.text for step in steps if step.holds is not True]
