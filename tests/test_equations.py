"""Equations of effects, laws and systems: every one is stated, explained and well-formed."""

import xml.etree.ElementTree as ET
from types import SimpleNamespace

import pytest

from tests import latex
from wedgesweep import equations
from wedgesweep.effects import EFFECTS, NAMES, REGISTERED
from wedgesweep.equations import notation
from wedgesweep.friction import LAWS
from wedgesweep.friction.names import LAW_NAMES, OSCILLATOR_LAWS
from wedgesweep.friction.quantities import FRICTION
from wedgesweep.systems import SYSTEMS

OF_EFFECTS = [(name, system) for name in NAMES for system in EFFECTS[name].systems]


def stated(name, system):
    return equations.of(REGISTERED[name], EFFECTS[name].quantities, system)


def all_stated():
    for name, system in OF_EFFECTS:
        yield stated(name, system)
    for name in LAW_NAMES:
        yield equations.of(LAWS[name], FRICTION)
    for name in (*LAW_NAMES, *OSCILLATOR_LAWS):
        yield equations.of(LAWS[name], FRICTION, "oscillator")
    for name, system in SYSTEMS.items():
        yield equations.of(system, system=name)


# Symbols of ratios and counts.
UNITLESS = {
    *("mu", "mu_s", "mu_d", "mu_c", "mu_b", "mu_0", "r", "b", "scale", "peak", "rate", "asymmetry", "share"),
    *("damping_ratio", "exponent", "velocity_exponent", "second", "third", "restitution", "locked_in"),
    *("s", "s_b", "spread", "i", *(f"b_{place}" for place in "i12345")),
}


def test_every_effect_law_and_system_has_equations_whose_symbols_are_explained():
    for each in all_stated():
        assert each.lines
        assert each.meanings
        for name, meaning in each.meanings.items():
            assert len(meaning.text) > 1, name
            assert meaning.unit or name in UNITLESS or "unit vector" in meaning.text, name
    for name, system in OF_EFFECTS:
        numbers = {each.name for each in EFFECTS[name].quantities if each.search}
        assert numbers <= set(stated(name, system).meanings)


def test_mathml_is_well_formed_and_holds_every_symbol():
    for each in all_stated():
        for line in each.lines:
            tree = ET.fromstring(notation.display(line))
            assert tree.tag == "math"
            assert tree.get("alttext") == line
            shown = "".join(tree.itertext())
            for name in notation.names(line):
                assert "".join(ET.fromstring(notation.symbol(name)).itertext()) in shown
        ET.fromstring(f"<p>{notation.prose(each.remark)}</p>")


def test_structure():
    assert notation.symbol("mu_s").count("<msub><mi>μ</mi><mi>s</mi></msub>") == 1
    assert "<mfrac><mi>v</mi><msub><mi>v</mi><mi>t</mi></msub></mfrac>" in notation.display("v/v_t")
    # Round brackets around all that is above, below or raised are not needed there.
    assert "stretchy" not in notation.display("(a + b)/(c + d)")
    assert notation.display("exp(-(a + b)/c)").count('stretchy="true"') == 2
    assert "<msubsup><mi>x</mi><mi>f</mi><mo>″</mo></msubsup>" in notation.display("x_f''")
    assert "<msqrt>" in notation.display("sqrt(k m)")
    assert "damping ratio" in notation.display("2 damping_ratio")
    assert "<msub><mi>σ</mi><mi>0</mi></msub>" in notation.display("sigma_0")
    assert notation.prose("a < $v_t$").startswith("a &lt; <math")


def test_latex():
    assert latex.line("mu = (mu_s + peak) v/v_t  for |v| <= v_t") == (
        r"\mu = (\mu_{s} + \mathrm{peak}) \frac{v}{v_{t}} \quad\text{for } \lvert v\rvert \le v_{t}"
    )
    assert latex.line("R = -c z'") == "R = - c z'"
    assert latex.line("2 damping_ratio k_sf") == r"2\, \mathrm{damping~ratio}\, k_{\mathrm{sf}}"
    assert latex.line("sqrt(v^2)") == r"\sqrt{v^{2}}"


def test_what_is_no_equation_and_symbols_that_nobody_explains_are_refused():
    for text in ("(a", "a)", "a +/ b", "a ^", "sin x", "a ? b", "|a", "a]"):
        with pytest.raises(ValueError, match=r"missing|closed|opens|cannot read"):
            notation.display(text)
    with pytest.raises(KeyError, match="lambda"):
        equations.of(SimpleNamespace(EQUATIONS=("R = lambda z",)))


def test_symbols_are_those_of_the_system():
    assert stated("guide_friction", "suspension").lines == ["R = -force sign(z')"]
    assert stated("guide_friction", "oscillator").lines == ["R = -force sign(v)"]
    assert stated("bolster_mass", "oscillator").lines == ["m -> scale m"]
