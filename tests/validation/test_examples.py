"""Two of the examples of an independent simulator; ``make validate`` diagnoses all of them."""

import pytest

from tests.validation import examples


@pytest.mark.skipif(not examples.TRUTH, reason="no ../shared/blind-examples beside the checkout")
@pytest.mark.parametrize("name", examples.QUICK)
def test_example_comes_out_right(name, tmp_path):
    examples.comes_out_right(name, tmp_path)
