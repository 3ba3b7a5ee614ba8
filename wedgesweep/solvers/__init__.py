"""Solvers: each follows one case from rest and returns the kept window as a Trajectory."""
