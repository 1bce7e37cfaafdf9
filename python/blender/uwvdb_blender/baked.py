"""A baked material on one mesh, and how it becomes a part of glTF's."""

SAMPLER = {"wrapS": 33071, "wrapT": 33071, "magFilter": 9729}  # held at the edges, linear


class Baked:
    """Texture coordinates of the corners of a mesh, and what a material is on it."""

    def __init__(self, content, uvs, wanted):
        """`wanted` are the channels that the bake was asked for."""
        self._content, self.uvs, self.wanted = content, uvs, wanted
        self.channels = {name.split("_")[0] for name in content}

    def put_into(self, exported, glb, threshold):
        """Puts what was baked in the place of what a materials.Exported has; textures go into a gltf.Glb. Alpha cuts
        holes where it is below the threshold; False if it is between 0 and 1 everywhere, and the surface opaque."""
        content, pbr, is_as_wanted = exported.content, exported.content["pbrMetallicRoughness"], True
        if "colour" in self.channels:
            factor, texture = self._factor("colour"), self._texture("colour", exported, glb)
            exported.colours = None
            pbr["baseColorFactor"] = factor[:3] + [1] if factor is not None else [1, 1, 1, 1]
            _set(pbr, "baseColorTexture", texture)
            if "alpha" in self.wanted:
                alpha = factor[3] if factor is not None and len(factor) > 3 else 1.0
                if texture is not None or alpha < threshold:
                    content.update(alphaMode="MASK", alphaCutoff=threshold)
                    pbr["baseColorFactor"][3] = alpha
                is_as_wanted = texture is not None or alpha < threshold or alpha == 1
        if "surface" in self.channels:
            pbr["roughnessFactor"], pbr["metallicFactor"] = self._factor("surface") or (1.0, 1.0)
            _set(pbr, "metallicRoughnessTexture", self._texture("surface", exported, glb))
        if "normal" in self.wanted:
            _set(content, "normalTexture", self._texture("normal", exported, glb))
        if "emission" in self.channels:
            self._put_emission(exported, glb)
        return is_as_wanted

    def _put_emission(self, exported, glb):
        content, factor = exported.content, self._factor("emission")
        strength = max(factor) if factor is not None else float(self._content["emission_strength"])
        texture = self._texture("emission", exported, glb) if strength > 0 else None
        light = [part / strength for part in factor] if factor is not None and strength > 0 else [1, 1, 1]
        _set(content, "emissiveFactor", light if strength > 0 else None)
        _set(content, "emissiveTexture", texture)
        _set(content["extensions"], "KHR_materials_emissive_strength",
             {"emissiveStrength": strength} if strength > 0 else None)

    def _factor(self, channel):
        """Numbers, where they are the same everywhere."""
        value = self._content.get(f"{channel}_factor")
        return None if value is None else [float(part) for part in value]

    def _texture(self, channel, exported, glb):
        """glTF's reference to a texture on the coordinates of the bake, or None."""
        png = self._content.get(f"{channel}_png")
        if png is None:
            return None
        if self not in exported.uv_maps:
            exported.uv_maps.append(self)
        return {"index": glb.add_texture(png.tobytes(), "image/png", SAMPLER), "texCoord": exported.uv_maps.index(self)}


def _set(content, name, value):
    """Sets an entry, or removes it."""
    content.pop(name, None)
    if value is not None:
        content[name] = value
