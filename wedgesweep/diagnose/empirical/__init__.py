"""The force that no named effect explains: a table, judged by tests left out, compared with names."""
