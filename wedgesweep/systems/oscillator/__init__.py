"""A mass on a spring that rubs on its base, on the ground or on a belt."""
