# Emotes in plain Python: which weight each unit of a face has, for a drawing or servos of one's own. The module in C draws faces itself.
import pantin
from pantin_emotes_data import EMOTES


class Emotes:
    """Plays emotes by name: `names` lists them, `weight(unit)` is what one does to a unit of the face, 0 to 1 for most."""

    names = tuple(sorted(EMOTES))

    def __init__(self, name="neutral", transition_ms=300):
        self.transition_ms = transition_ms
        self._before = {}
        self._clip = None
        self._now = self._start = 0
        self.show(name)

    def show(self, name):
        """Goes over to an emote, from the weights that are shown now. Raises KeyError if there is none of this name."""
        if name not in EMOTES:
            raise KeyError("no emote " + name)
        before = self.weights() if self._clip else {}
        self._clip = pantin.Clip(EMOTES[name])
        self._units = [scalar[2] for scalar in self._clip.rig.scalars]
        self._before = before
        self._start = self._now
        self.name = name

    def update(self, ms):
        """Shows the weights of a time in milliseconds, which goes on from call to call."""
        self._now = ms
        self._clip.update(ms - self._start)

    def weights(self):
        """The weights of all units that are not 0, by their names."""
        passed = self._now - self._start
        share = min(passed / self.transition_ms, 1) if self.transition_ms else 1
        # Slow, fast, slow.
        share = share * share * (3 - 2 * share)
        weights = {}
        for unit, weight in self._before.items() if share < 1 else ():
            weights[unit] = weight * (1 - share)
        for unit in self._units:
            weights[unit] = weights.get(unit, 0) + self._clip.scalar(unit) * share
        return weights

    def weight(self, unit):
        """The weight of one unit, such as "blink": 0 if the emote does not use it."""
        return self.weights().get(unit, 0)
