"""Games on the table: the noise of a player's strike.

Pure functions, the same as in C++ (`carom/games/*.h`).
"""

from carom.games._noise import STRIKE, Noise, noisy

__all__ = ["STRIKE", "Noise", "noisy"]
