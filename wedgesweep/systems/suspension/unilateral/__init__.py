"""The suspension with unilateral joints: both faces of a wedge may lift off, fall back and hit."""
