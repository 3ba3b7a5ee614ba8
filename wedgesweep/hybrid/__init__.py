"""Hybrid systems: smooth modes, events between them, and what every solver needs of both."""
