"""Sweeps: cases solved in parallel, kept safe while they run, and put together as one labelled dataset."""
