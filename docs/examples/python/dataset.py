"""A data set that is rendered when it is asked for, in the form that PyTorch's data loaders take:
an object with a length whose items are arrays. It needs no PyTorch.

    python3 dataset.py 4
"""

import argparse
import multiprocessing

import numpy as np

import uwvdb


class UnderwaterImages:
    """Images of one scene in waters of every turbidity, with their depth and their clean colours.

    A loader's worker processes, forked or spawned, each get a copy of it and render by themselves:
    the renderer is made where it is used first, and is not pickled.
    """

    def __init__(self, length, size=(128, 96), seed=0):
        self.length, self.size, self.seed = length, size, seed
        self.scene = uwvdb.Scene(
            camera={"resolution": [320, 240], "intrinsics": {"fov_x": 60}},
            water={"preset": "jerlov-II"},
            geometry=[{"type": "plane", "point": [0, 0.6, 0], "normal": [0, -1, 0]},
                      {"type": "sphere", "center": [0, 0.1, 2], "radius": 0.3}],
            lamps=[{"name": "lamp", "position": [0.4, -0.4, 0], "direction": [-0.2, 0.2, 1],
                    "intensity": 40}])
        self._renderer = None

    def __len__(self):
        return self.length

    def __getitem__(self, index):
        if not 0 <= index < self.length:
            raise IndexError(index)
        if self._renderer is None:
            self._renderer = uwvdb.Renderer(threads=1)
        rng = np.random.default_rng((self.seed, index))
        scene = self.scene.copy()
        scene.update({"water.particles": {"small": rng.uniform(0, 0.05),
                                          "large": rng.uniform(0, 1)},
                      "lamps.lamp.position": rng.uniform([-0.6, -0.6, -0.2], [0.6, 0, 0.2]),
                      "geometry[1].reflectance": rng.uniform(0.1, 0.9, 3)})
        image = self._renderer.render(scene, ["total", "depth", "clean"], size=self.size)
        # Channels first, contiguous, as torch.from_numpy and default_collate like them.
        return {"image": np.ascontiguousarray(np.moveaxis(image["total"], -1, 0)),
                "clean": np.ascontiguousarray(np.moveaxis(image["clean"], -1, 0)),
                "depth": image["depth"][None].copy()}

    def __getstate__(self):
        return {**self.__dict__, "_renderer": None}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split(",")[0])
    parser.add_argument("length", type=int, nargs="?", default=4, help="how many images")
    images = UnderwaterImages(parser.parse_args().length)
    # What DataLoader(images, batch_size=None, num_workers=2) does.
    with multiprocessing.Pool(2) as workers:
        for number, item in enumerate(workers.imap(images.__getitem__, range(len(images)))):
            print(number, {name: array.shape for name, array in item.items()},
                  f"mean {item['image'].mean():.4f}")


if __name__ == "__main__":
    main()
