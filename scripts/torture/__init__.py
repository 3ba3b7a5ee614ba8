"""Hostile input and violent ends: what ``fuzz.py`` and ``kill_campaign.py`` do, in parts that tests use."""
