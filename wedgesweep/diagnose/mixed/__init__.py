"""Tests of several kinds in one fit: one model, one verdict."""
