"""InnerSphere inside PyBullet."""

from .pybullet_world import PyBulletWorld


class PyBulletPackings(PyBulletWorld):
    name = "innersphere-pybullet"
    settings = "packings of 1,000 spheres in PyBullet, attach() with its defaults (plugin/python/README.md); PyBullet's 50 iterations"

    @classmethod
    def version(cls) -> str:
        import innersphere.pybullet

        return f"innersphere {innersphere.__version__}, {super().version()}"

    def _attach(self) -> None:
        import innersphere.pybullet

        self._innersphere = innersphere
        self._simulation = innersphere.pybullet.attach(self._client)
        self._packings = {}

    def _shape(self, body: dict) -> int:
        return self._p.createCollisionShape(self._p.GEOM_SPHERE, radius=1e-3)  # until it gets its packing

    def _finish(self, body: dict, number: int, link: int) -> None:
        file = body["packing"]
        if file not in self._packings:
            self._packings[file] = self._innersphere.read(file)
        self._simulation.set_shape(number, self._packings[file], link)


ENGINES = [PyBulletPackings]
