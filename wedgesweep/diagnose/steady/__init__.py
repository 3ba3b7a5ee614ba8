"""Records of steady responses, compared with simulations harmonic by harmonic."""
