"""A first measured.toml and its model from nothing but the files of a measurement."""
