"""Overlaps as functions of torch, with exact gradients by the poses.

    import torch
    import innersphere
    import innersphere.torch

    query, part = innersphere.Query(), innersphere.read("part.cbor")
    position = torch.tensor([0.1, 0, 0], dtype=torch.float64, requires_grad=True)
    quaternion = torch.tensor([0, 0, 0, 1.0], dtype=torch.float64, requires_grad=True)
    innersphere.torch.energy(query, part, part, None, (position, quaternion)).backward()

Queries run where the Query object runs; tensors of a device are copied there and back.
"""

from __future__ import annotations

from typing import Any, Literal

import torch

from ._core import Packing, Query
from ._gradients import value_and_gradients

__all__ = ["energy", "volume"]


class _Function(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, call: Any, *tensors: torch.Tensor) -> torch.Tensor:
        what, query, a, b, counts, options = call
        arrays = [tensor.detach().cpu().double().numpy() for tensor in tensors]
        poses = []
        for count in counts:
            poses.append(None if count == 0 else arrays[0] if count == 1 else tuple(arrays[:2]))
            arrays = arrays[count:]
        value, gradients = value_and_gradients(what, query, a, b, *poses, **options)
        ctx.shapes = [tensor.shape for tensor in tensors]
        ctx.save_for_backward(*(torch.from_numpy(g).to(t) for g, t in zip(gradients, tensors)))
        result = torch.from_numpy(value.copy())
        return result.to(tensors[0]) if tensors else result

    @staticmethod
    @torch.autograd.function.once_differentiable
    def backward(ctx: Any, *outputs: torch.Tensor) -> Any:
        (output,) = outputs
        gradients = []
        for gradient, shape in zip(ctx.saved_tensors, ctx.shapes):
            all_of_it = gradient * output.reshape(output.shape + (1,) * (gradient.dim() - output.dim()))
            gradients.append(all_of_it.sum_to_size(shape))
        return (None, *gradients)


def _apply(what: Literal["energy", "volume"], query: Query, a: Packing, b: Packing, poses: Any, options: Any) -> Any:
    tensors: list[torch.Tensor] = []
    counts = []
    for pose in poses:
        parts = [] if pose is None else list(pose) if isinstance(pose, tuple) else [pose]
        counts.append(len(parts))
        tensors += [torch.as_tensor(part) for part in parts]
    return _Function.apply((what, query, a, b, counts, options), *tensors)


def energy(
    query: Query, a: Packing, b: Packing, pose_a: Any = None, pose_b: Any = None, **options: Any
) -> torch.Tensor:
    """The potential of the force that drives two packings apart [m^4], for unit stiffness.

    Arguments and errors are those of Query.overlap(), with estimator and margin for options; poses are tensors: matrices
    (..., 4, 4), or tuples of positions (..., 3) and unit quaternions (..., 4), x y z w. Returns a tensor of the shape
    before that, of the type and device of the first tensor. Gradients are along rotations: normalise quaternions after a
    step. They cannot be differentiated again.
    """
    return _apply("energy", query, a, b, (pose_a, pose_b), options)


def volume(
    query: Query, a: Packing, b: Packing, pose_a: Any = None, pose_b: Any = None, **options: Any
) -> torch.Tensor:
    """The volume that two packings share [m^3]. As energy(), but it takes a second query, for contacts of spheres."""
    return _apply("volume", query, a, b, (pose_a, pose_b), options)
