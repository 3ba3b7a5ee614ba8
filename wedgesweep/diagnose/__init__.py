"""From measured data to a named cause: what the model misses, what explains it, and what that gains."""
