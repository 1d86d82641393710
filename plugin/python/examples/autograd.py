"""torch moves and turns a gear until its teeth mesh with those of another."""

import torch

import innersphere
import innersphere.torch

gear = innersphere.pack(innersphere.solid("gear"), spheres=4000, cache="packings", overlap_errors=False)
query, none = innersphere.Query(), torch.zeros((), dtype=torch.float64)
place = torch.tensor([1.05, 0.1], dtype=torch.float64, requires_grad=True)
angle = torch.tensor(0.1, dtype=torch.float64, requires_grad=True)
descent = torch.optim.Adam([place, angle], lr=0.003)
for step in range(600):
    position = torch.stack([place[0], place[1], none])
    quaternion = torch.stack([none, none, torch.sin(angle / 2), torch.cos(angle / 2)])
    shared = innersphere.torch.volume(query, gear, gear, None, (position, quaternion))
    loss = position.norm() + 1000 * shared  # near, but not in each other
    descent.zero_grad()
    loss.backward()
    descent.step()
    descent.param_groups[0]["lr"] *= 0.993
apart, share = float(position.norm()), float(shared) / gear.volume
print(f"two gears of 1.028 m are {apart:.3f} m apart, and share {100 * share:.3f} % of their volume")
