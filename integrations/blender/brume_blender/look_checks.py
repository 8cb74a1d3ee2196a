"""What of materials and lights is not exported, or looks different in Brume: one message for each kind."""

from . import light_nodes, surfaces

_KINDS = {
    "MIX": "mixed shaders become one, with the mean of their settings",
    "BUMP": "bumps are not exported, only images of normals",
    "PLACED": "images are placed by UV coordinates alone",
    "SUBSURFACE": "subsurface scattering is not exported",
    "FAINT": "a transmission below 0.5 is drawn opaque",
    "VEIL": "an alpha from 0.5 on is drawn opaque",
    "DISPLACEMENT": "displacement is not exported",
    "VOLUME": "the volume inside of meshes is not exported",
}


def listed(noun, labels):
    """The name of one thing, or of the first two of several."""
    if len(labels) == 1:
        return f'the {noun} "{labels[0]}"'
    rest = f" and {len(labels) - 2} more" if len(labels) > 2 else ""
    between = ", " if rest else " and "
    return f'the {noun}s "{labels[0]}"{between}"{labels[1]}"{rest}'


def check(level, warnings):
    _check_materials(level, warnings)
    _check_lights(level, warnings)
    if level.hairy:
        warnings.add(f"the hair of {listed('object', level.hairy)} is not exported")
    if level.only_volumes:
        warnings.add(f"{listed('object', level.only_volumes)}: not exported, because the material is a volume alone")


def _check_materials(level, warnings):
    kinds, glowing = {}, []
    slots = {slot: None for thing in level.things for piece in thing.pieces for slot in piece.materials}
    for material in filter(None, slots):
        surface = surfaces.surface_of(material)
        for kind in sorted(_kinds_of(material, surface)):
            kinds.setdefault(kind, []).append(material.name)
        if surface and surface.lost:
            warnings.add(f'the material "{material.name}": ' + "; ".join(dict.fromkeys(surface.lost)))
        if surface and _glows(surface):
            glowing.append(material.name)
    for kind, labels in kinds.items():
        if kind.startswith("SHADER "):
            text = f"the shader {kind[len('SHADER ') :]} becomes a plain one"
        else:
            text = _KINDS[kind]
        warnings.add(f"{listed('material', labels)}: {text}")
    if len(glowing) == 1:
        warnings.note(f'the material "{glowing[0]}" glows, but it lights nothing: add a light beside it')
    elif glowing:
        warnings.note(f"{listed('material', glowing)} glow, but light nothing: add lights beside them")


def _kinds_of(material, surface):
    kinds = set(surface.kinds) if surface else set()
    if surface and surface.alpha.image is None and 0.5 <= surface.alpha.value[0] < 1:
        kinds.add("VEIL")
    kinds |= {name.upper() for name in ("Volume", "Displacement") if surfaces.is_linked(material, name)}
    return kinds


def _glows(surface):
    has_color = surface.emission.image is not None or surface.emission.value.max() > 0
    return has_color and surface.strength.value[0] > 0


def _check_lights(level, warnings):
    with_nodes = {}
    for light in level.lights:
        for name in light_nodes.factor_of(light.data)[1]:
            with_nodes.setdefault(name, []).append(light.label)
    for name, labels in with_nodes.items():
        warnings.add(f"{listed('light', labels)}: the node {name} is not exported")
    areas = [light.label for light in level.lights if light.data.type == "AREA"]
    if areas:
        verb = "casts" if len(areas) == 1 else "cast"
        warnings.note(f"{listed('area light', areas)} {verb} hard shadows: Brume has no soft ones")
