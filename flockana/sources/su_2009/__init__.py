"""Su, Wang and Lin (2009): few informed agents, and a leader of varying velocity."""
