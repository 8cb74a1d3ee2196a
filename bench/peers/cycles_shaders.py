"""Shaders of Cycles that follow Brume's models, inside Blender."""
import bpy


class Nodes:
    """The nodes of a material or a world. Values are outputs of nodes, or numbers."""

    def __init__(self, owner):
        owner.use_nodes = True
        self._tree = owner.node_tree
        self._tree.nodes.clear()

    @classmethod
    def of(cls, material):
        """Those that a material has, and more."""
        made = cls.__new__(cls)
        made._tree = material.node_tree
        return made

    def add(self, kind, **settings):
        node = self._tree.nodes.new("ShaderNode" + kind)
        for name, value in settings.items():
            setattr(node, name, value)
        return node

    def set(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self._tree.links.new(value, socket)
        else:
            socket.default_value = value

    def math(self, operation, *values):
        node = self.add("Math", operation=operation)
        for socket, value in zip(node.inputs, values):
            self.set(socket, value)
        return node.outputs[0]

    def dot(self, a, b):
        node = self.add("VectorMath", operation="DOT_PRODUCT")
        self.set(node.inputs[0], a)
        self.set(node.inputs[1], b)
        return node.outputs["Value"]

    def scaled(self, color, factor):
        node = self.add("VectorMath", operation="SCALE")
        self.set(node.inputs[0], color)
        self.set(node.inputs["Scale"], factor)
        return node.outputs["Vector"]

    def mapped_normal(self, image):
        node = self.add("NormalMap")
        self.set(node.inputs["Color"], self.add("TexImage", image=image).outputs["Color"])
        return node.outputs["Normal"]


class Material:
    """Several shaders, of which one is shown at a time."""

    def __init__(self, name):
        self.material = bpy.data.materials.new(name)
        self.nodes, self._of_kind = Nodes(self.material), {}
        self._output = self.nodes.add("OutputMaterial")

    def exported(self, color, roughness, **inputs):
        """Adds `principled`, which is exported: a specular part of 0.04, as Brume has it."""
        self.add("principled", "BsdfPrincipled", Base_Color=color, Roughness=roughness, Specular=0.5, **inputs)

    def add(self, kind, node, **inputs):
        """Sockets are named with _ in place of blanks."""
        self._of_kind[kind] = made = self.nodes.add(node)
        for name, value in inputs.items():
            self.nodes.set(made.inputs[name.replace("_", " ")], value)
        return made

    def show(self, kind):
        self.nodes.set(self._output.inputs["Surface"], self._of_kind[kind].outputs[0])


def schlick(nodes, color, facing):
    """Fresnel's term by Schlick, of the cosine between eye and normal in place of that between eye and half vector:
    of a smooth surface the two are nearly one."""
    node = nodes.add("MixRGB")
    nodes.set(node.inputs["Fac"], nodes.math("POWER", nodes.math("SUBTRACT", 1.0, facing), 5.0))
    nodes.set(node.inputs["Color1"], (*color, 1))
    nodes.set(node.inputs["Color2"], (1, 1, 1, 1))
    return node.outputs["Color"]


def hammon(nodes, roughness, facing):
    """What Hammon's approximation of Smith's term, which Brume uses, takes from a smooth surface, where the cosines of
    eye and light are nearly one: c / (c (1 - alpha) + alpha). Smith's own is nearly 1 there."""
    alpha, cosine = roughness * roughness, nodes.math("MAXIMUM", facing, 1e-3)
    return nodes.math("DIVIDE", cosine, nodes.math("MULTIPLY_ADD", cosine, 1 - alpha, alpha))


def _background(color):
    made = bpy.data.worlds.new("world")
    # Its default takes longer than a small picture.
    made.cycles.sampling_method, made.cycles.sample_map_resolution = "MANUAL", 64
    nodes = Nodes(made)
    background = nodes.add("Background")
    nodes.set(background.inputs["Color"], (*color, 1))
    nodes.set(nodes.add("OutputWorld").inputs["Surface"], background.outputs[0])
    return made, nodes, background.inputs["Strength"]


def plain_world(color):
    """As the add-on exports it: one colour from all directions."""
    return _background(color)[0]


def brume_world(color):
    """What Brume makes of a plain world: the eye sees the colour; what is lit receives it times
    1 + 0.5 z, of which 1 is the mean (shaders/shared/sky_light.h)."""
    made, nodes, strength = _background(color)
    height = nodes.add("SeparateXYZ")
    nodes.set(height.inputs[0], nodes.add("TexCoord").outputs["Generated"])
    lighting = nodes.math("MULTIPLY_ADD", height.outputs["Z"], 0.5, 1)
    is_eye = nodes.add("LightPath").outputs["Is Camera Ray"]
    nodes.set(strength, nodes.math("MULTIPLY_ADD", is_eye, nodes.math("SUBTRACT", 1.0, lighting), lighting))
    return made
