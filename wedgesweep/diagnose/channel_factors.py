"""How a recorded channel becomes the motion that is simulated."""

from wedgesweep.config import Config


def channel_factors(model: Config, of: str) -> tuple[float, float]:
    """Factors of a channel and of the input's displacement in the motion that is simulated.

    Their sum is base less mass for the suspension. For the oscillator it is mass less base, or the mass's own
    motion where its contact or a force does not move with the base.

    Parameters
    ----------
    model : Config
        The base model.
    of : str
        The motion that the channel shows: "relative" to the base, or "absolute".
    """
    if model.system == "suspension":
        return (1.0, 0.0) if of == "relative" else (-1.0, 1.0)
    if of in model.simulated_motion:
        return 1.0, 0.0
    return 1.0, 1.0 if of == "relative" else -1.0
