"""What to measure next: the kind of test, with its numbers, that would separate explanations."""
