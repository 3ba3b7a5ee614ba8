"""Hysteresis loops, one kind of record: the motion is imposed and recorded, and the force is compared."""
