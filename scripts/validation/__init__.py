"""Validation campaign: hide effects in synthetic measurements, diagnose them, and compare with the truth.

The command line makes and diagnoses every data set, as a user would. Data of effects that no candidate
stands for come from an independent simulator (``simulator.py``). Run it with
``PYTHONPATH=scripts python -m validation --seed N --output DIR``.
"""
