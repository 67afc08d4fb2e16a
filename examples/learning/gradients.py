#!/usr/bin/env python3
"""A shot as a function with derivatives, for NumPy, PyTorch and JAX: numbers of a scene in, places of the
balls at the end out.

    python examples/learning/gradients.py    # compares the derivatives with differences, by what is installed

Derivatives hold while the order of events does, and a shot without them raises ValueError
(docs/guide/find.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import carom
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Shot:
    """Places of all balls at the end [m], as a function of numbers of the scene."""

    def __init__(self, scene: carom.Scene, inputs: Sequence[str]) -> None:
        self.scene, self.inputs = scene, list(inputs)

    def play(self, x: Any) -> carom.Record:
        return carom.simulate(self.scene.replace(**dict(zip(self.inputs, np.asarray(x, float).tolist()))))

    def __call__(self, x: Any) -> Array:
        record = self.play(x)
        return record.states(record.duration)[:, 0, :2]

    def with_slopes(self, x: Any) -> tuple[Array, Array]:
        """The places, and their derivatives: (balls, 2) and (balls, 2, inputs)."""
        record = self.play(x)
        return record.states(record.duration)[:, 0, :2], record.jacobian(self.inputs)[:, 0, :2]


def pulled(slopes: Array, pull: Array) -> Array:
    """Backwards: derivatives of a number by the inputs, from those by the places."""
    return np.asarray(np.einsum("bak,ba->k", slopes, pull))


def pushed(slopes: Array, push: Array) -> Array:
    """Forwards: how the places move if the inputs move by `push`."""
    return slopes @ push


def for_torch(shot: Shot) -> Callable[[Any], Any]:
    """The shot for PyTorch: a float64 tensor of the inputs to one of the places."""
    import torch  # type: ignore[import-not-found, unused-ignore]

    class Play(torch.autograd.Function):  # type: ignore[misc, unused-ignore]
        @staticmethod
        def forward(ctx: Any, x: Any) -> Any:
            places, slopes = shot.with_slopes(x.detach().numpy())
            ctx.slopes = slopes
            return torch.from_numpy(places.copy())

        @staticmethod
        def backward(ctx: Any, pull: Any) -> Any:
            return torch.from_numpy(pulled(ctx.slopes, pull.numpy()))

    return Play.apply  # type: ignore[no-any-return, unused-ignore]


def for_jax(shot: Shot) -> Callable[[Any], Any]:
    """The shot for JAX, with jvp, vjp, grad and jit. Enable jax_enable_x64 first."""
    import jax  # type: ignore[import-not-found, unused-ignore]
    import jax.numpy as jnp  # type: ignore[import-not-found, unused-ignore]

    balls, inputs = len(shot.scene.ids), len(shot.inputs)
    shapes = (jax.ShapeDtypeStruct((balls, 2), jnp.float64),
              jax.ShapeDtypeStruct((balls, 2, inputs), jnp.float64))

    @jax.custom_jvp  # type: ignore[untyped-decorator, unused-ignore]
    def play(x: Any) -> Any:
        return jax.pure_callback(shot, shapes[0], x)

    @play.defjvp  # type: ignore[untyped-decorator, unused-ignore]
    def slopes_of(at: Any, push: Any) -> Any:
        places, slopes = jax.pure_callback(shot.with_slopes, shapes, at[0])
        return places, slopes @ push[0]

    return play  # type: ignore[no-any-return, unused-ignore]


def main() -> None:
    shot = Shot(carom.Scene.load("scenes/draw.toml"), ["cue.speed", "cue.aim_deg", "cue.offset.height"])
    x, step = np.array([2.25, 135.0, -0.4]), 1e-5
    slopes = shot.with_slopes(x)[1]
    apart = [abs((shot(x + step * e) - shot(x - step * e)) / (2 * step) - slopes[..., k]).max()
             for k, e in enumerate(np.eye(3))]
    print("NumPy: differences agree within", max(apart))
    try:
        import torch

        print("PyTorch:", torch.autograd.gradcheck(for_torch(shot), torch.tensor(x, requires_grad=True)))
    except ImportError as missing:
        print("PyTorch:", missing)
    try:
        import jax

        jax.config.update("jax_enable_x64", True)
        print("JAX:", abs(np.asarray(jax.jacobian(for_jax(shot))(x)) - slopes).max())
    except ImportError as missing:
        print("JAX:", missing)


if __name__ == "__main__":
    main()
