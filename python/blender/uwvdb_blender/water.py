"""The section `water` of a scene, from World > Water and Render > Forward Scatter."""

from . import bands as colours

DEFAULT_PRESET = "jerlov-II"


def describe(scene, bands, to_metres):
    world = scene.world
    water = {"bands": bands}
    if world is None:
        water["preset"] = DEFAULT_PRESET
        return water
    settings = world.uwvdb
    if settings.kind == "NONE":
        water.update(_explicit([0.0] * 3, [0.0] * 3, 0.0, bands))
    elif settings.kind == "COEFFICIENTS":
        water.update(_explicit(settings.absorption, settings.scattering, settings.hg_g, bands))
        water.update(salinity=settings.salinity, temperature=settings.temperature)
    else:
        if settings.kind == "CONSTITUENTS":
            water.update(cdom=settings.cdom, chlorophyll=settings.chlorophyll)
        else:
            water["preset"] = settings.preset
        water.update(salinity=settings.salinity, temperature=settings.temperature)
        if settings.kind == "CONSTITUENTS" or settings.use_particles:
            water["particles"] = {"small": settings.small, "large": settings.large}
    if settings.use_surface:
        water["surface"] = {"point": [0, 0, settings.surface_height * to_metres.median_scale],
                            "normal": [0, 0, 1]}
    if settings.use_snow:
        water["snow"] = {"number": settings.snow_number,
                         "diameter": [f"{settings.snow_least} mm", f"{settings.snow_greatest} mm"],
                         "exponent": settings.snow_exponent, "reflectance": settings.snow_reflectance,
                         "drift": [speed * to_metres.median_scale for speed in settings.snow_drift],
                         "seed": settings.snow_seed,
                         "mean": settings.snow_mean.lower()}
    render = scene.uwvdb
    if render.use_forward_scatter:
        water["forward_scatter"] = {"K": render.forward_strength, "G": render.forward_g,
                                    "B": render.forward_b, "shape": render.forward_shape.lower()}
    return water


def _explicit(absorption, scattering, g, bands):
    return {"absorption": colours.from_rgb(absorption, bands),
            "scattering": {"b": colours.from_rgb(scattering, bands), "phase": {"type": "hg", "g": g}}}
