"""What a calibration in water makes of a flat port: the corners of a checkerboard, seen through
the port, are given to the pinhole model of OpenCV, which has no port. It takes the port's
refraction for a longer focal length, for distortion and for a camera somewhere else, and is right
for the distances it was made at only.

    python3 flat_port_calibration.py             the model of cv2.calibrateCamera, by scipy
    python3 flat_port_calibration.py --opencv    cv2.calibrateCamera itself, from OpenCV
"""

import argparse

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

import uwvdb

BOARD = np.stack([*np.meshgrid(np.arange(9) * 0.04, np.arange(7) * 0.04), np.zeros((7, 9))],
                 axis=-1).reshape(-1, 3) - [0.16, 0.12, 0]


def scene():
    return uwvdb.Scene(camera={
        "resolution": [1280, 960],
        "intrinsics": {"fx": 900, "fy": 900, "cx": 640, "cy": 480},
        "port": {"type": "flat", "distance": 0.03, "thickness": 0.01}})


def poses(distance, seed=1, count=12):
    """Of the board in the camera's axes: rotation vector and translation, (count, 6)."""
    rng = np.random.default_rng(seed)
    turned = rng.uniform(-0.5, 0.5, (count, 3))
    placed = rng.uniform([-0.12, -0.1, 0.9], [0.12, 0.1, 1.1], (count, 3)) * distance
    return np.hstack([turned, placed])


def placed(pose):
    return Rotation.from_rotvec(pose[:3]).apply(BOARD) + pose[3:]


def opencv_model(parameters, points):
    """Pixels of points in the camera's axes by fx, fy, cx, cy, k1, k2, p1, p2, k3."""
    fx, fy, cx, cy, k1, k2, p1, p2, k3 = parameters
    x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
    r = x * x + y * y
    radial = 1 + r * (k1 + r * (k2 + r * k3))
    return np.stack([fx * (x * radial + 2 * p1 * x * y + p2 * (r + 2 * x * x)) + cx,
                     fy * (y * radial + p1 * (r + 2 * y * y) + 2 * p2 * x * y) + cy], axis=-1)


def calibrated_by_scipy(corners, first_poses):
    """Parameters, where the boards are for them, and the RMS distance of the corners from the model
    [pixels], as OpenCV has it."""
    def residuals(unknowns):
        found = [opencv_model(unknowns[:9], placed(pose)) for pose in unknowns[9:].reshape(-1, 6)]
        return (np.array(found) - corners).ravel()
    first = np.concatenate([[1200, 1200, 640, 480, 0, 0, 0, 0, 0], first_poses.ravel()])
    result = least_squares(residuals, first, x_scale="jac")
    rms = np.sqrt(np.mean(np.sum(result.fun.reshape(-1, 2) ** 2, axis=1)))
    return result.x[:9], result.x[9:].reshape(-1, 6)[:, 3:], rms


def calibrated_by_opencv(corners, size):
    import cv2
    boards = [BOARD.astype(np.float32)] * len(corners)
    # OpenCV's first pixel's centre is (0, 0).
    rms, matrix, distortion, _, places = cv2.calibrateCamera(
        boards, (corners - 0.5).astype(np.float32), size, None, None)
    return np.array([matrix[0, 0], matrix[1, 1], matrix[0, 2] + 0.5, matrix[1, 2] + 0.5,
                     *distortion.ravel()[:5]]), np.reshape(places, (-1, 3)), rms


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--opencv", action="store_true")
    arguments = parser.parse_args()
    camera = scene().camera
    shown = poses(0.8)
    corners = np.array([camera.project(placed(pose)) for pose in shown])
    if arguments.opencv:
        found, places, rms = calibrated_by_opencv(corners, (camera.width, camera.height))
    else:
        found, places, rms = calibrated_by_scipy(corners, shown)
    print("in air    fx 900.0, no distortion")
    moved = (places - shown[:, 3:]).mean(axis=0)
    print(f"in water  fx {found[0]:.1f}, k1 {found[4]:.4f}, k2 {found[5]:.4f}, "
          f"centre moved by {-1000 * moved[2]:.1f} mm, RMS {rms:.4f} pixels")
    # The same model at other distances, along the camera's own rays, where the boards were.
    rays = camera.rays(camera.pixel_centres()[200:760:80, 280:1000:80].reshape(-1, 2))
    for distance in (0.2, 0.4, 0.8, 2, 8):
        points = rays.origin + rays.direction * (distance / rays.direction[:, 2:])
        error = opencv_model(found, points + moved) - camera.project(points, beyond=True)
        print(f"at {distance:3} m  largest error {np.linalg.norm(error, axis=1).max():.2f} pixels")


if __name__ == "__main__":
    main()
