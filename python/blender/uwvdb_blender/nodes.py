"""Node trees as they are read: through groups, reroutes and muted nodes, with what is constant in them folded."""

from . import folding


def output_of(owner):
    """The Node of the output, which Cycles renders, of a material, light or world with a tree; None if it has none."""
    tree = owner.node_tree
    found = tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
    return Node(found) if found is not None else None


def source_of(socket):
    """The (Node, its output) that feeds an Input; None if nothing does, or only what is constant, which then is the
    Input's default_value."""
    return socket.source


def reachable(node):
    """All Nodes that have an effect on one, with it."""
    found, waiting = {}, [node]
    while waiting:
        node = waiting.pop()
        if node.key in found:
            continue
        found[node.key] = node
        waiting += [socket.feeder[0] for socket in node.inputs if socket.feeder is not None]
    return list(found.values())


class Node:
    """A node of Blender, all of whose settings it has, within the groups around it: the group nodes from outside to
    inside."""

    def __init__(self, node, groups=()):
        self.bpy_node, self.groups = node, groups
        self.inputs = _Inputs(Input(socket, groups) for socket in node.inputs)

    def __getattr__(self, name):
        return getattr(self.bpy_node, name)

    @property
    def key(self):
        return tuple(node.as_pointer() for node in (*self.groups, self.bpy_node))

    @property
    def values(self):
        """The inputs that its settings leave."""
        return [socket for socket in self.inputs if socket.enabled]


class _Inputs(list):
    """Found by number, or by name as in Blender."""

    def __getitem__(self, key):
        if not isinstance(key, str):
            return super().__getitem__(key)
        found = self.get(key)
        if found is None:
            raise KeyError(key)
        return found

    def __contains__(self, key):
        return self.get(key) is not None if isinstance(key, str) else super().__contains__(key)

    def get(self, name):
        return next((socket for socket in self if socket.name == name), None)


class Input:
    """What a node takes: `default_value` unless something that is not constant feeds it."""

    def __init__(self, socket, groups):
        self.socket, self.groups = socket, groups
        self.name, self.type, self.enabled = socket.name, socket.type, socket.enabled
        self._read = None

    @property
    def feeder(self):
        """The (Node, its output) that feeds it, constant or not."""
        return self._looked_up()[0]

    @property
    def source(self):
        return self._looked_up()[1]

    @property
    def is_linked(self):
        return self.source is not None

    @property
    def default_value(self):
        value = self._looked_up()[2]
        return self.socket.default_value if value is None else value

    def _looked_up(self):
        """(feeder, the same unless it is constant, the constant or None)"""
        if self._read is None:
            feeder, end = _followed(self.socket, self.groups)
            value = None
            if feeder is not None:
                value = folding.constant(*feeder)
                kind = feeder[1].type
            elif end is not self.socket and hasattr(end, "default_value"):
                value, kind = folding.plain(end.default_value), end.type
            value = folding.converted(value, kind, self.type) if value is not None else None
            self._read = feeder, None if value is not None else feeder, value
        return self._read


def _followed(socket, groups):
    """(what feeds a socket as (Node, its output) or None, the socket at which the way ends)"""
    while True:
        link = next((link for link in socket.links if link.is_valid and not link.is_muted), None) \
            if socket.is_linked else None
        if link is None:
            return None, socket
        node, output = link.from_node, link.from_socket
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute:
            inner = next((i.from_socket for i in node.internal_links if i.to_socket == output), None)
            if inner is None:
                return None, socket
            socket = inner
        elif node.type == "GROUP" and node.node_tree is not None:
            inside = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
            found = _by_identifier(inside.inputs, output) if inside is not None else None
            if found is None:
                return None, output
            socket, groups = found, (*groups, node)
        elif node.type == "GROUP_INPUT" and groups:
            found = _by_identifier(groups[-1].inputs, output)
            if found is None:
                return None, output
            socket, groups = found, groups[:-1]
        else:
            return (Node(node, groups), output), socket


def _by_identifier(sockets, other):
    return next((socket for socket in sockets if socket.identifier == other.identifier), None)
