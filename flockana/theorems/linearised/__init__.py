"""What the linearisation predicts of a run."""
