"""The friction wedge suspension of a three-piece bogie, as a half model."""
