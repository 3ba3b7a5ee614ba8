"""Reads CSV files of many dialects."""
