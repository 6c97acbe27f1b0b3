# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""MuJoCo: flexes of the same tets (dof full), or of a grid of cells around them (trilinear, quadratic).

Their material is Saint Venant-Kirchhoff's; damping is Rayleigh's, in seconds, as ours. A flex divides its mass evenly
among its points: the masses of the tets are set after the model has been compiled. Its elasticity is implicit under the
integrator "discrete" alone, and explicit under "Euler". The friction of a contact would be the larger of the two: that
of planes and rigid bodies is given priority. The settings of their own examples are those of model/flex/mechanisms:
discrete, Newton, a tolerance of 1e-7, steps of 1 ms. A flex yields by sqrt(2/3) of the norm of its strain's deviator,
as one tet in a given strain shows, at once. What is moved is heavy, and gets velocities.
"""
import mujoco
import numpy as np

from problem import GRAVITY, Unsupported
from shapes import surface_of

VERSION = mujoco.__version__
NO_SKIN = "it attaches surfaces to a grid of cells of its own, and simulates that: none to given tets"
HEAVY = 1e4  # kg
RADIUS = 0.002  # of the vertices, in contact: that of their examples


def numbers(rows):
    return " ".join(f"{value:.9g}" for value in np.ravel(rows))


class Simulation:
    """substeps: per frame. cells: of the grid, or None for the tets themselves; order: 1 or 2, of the cells."""

    def __init__(self,
                 substeps=16,
                 integrator="discrete",
                 solver="CG",
                 tolerance=1e-8,
                 iterations=100,
                 cells=None,
                 order=2,
                 gravity=GRAVITY):
        self.substeps, self.cells, self.order = substeps, cells, order
        self.option = (f'<option gravity="{numbers(gravity)}" integrator="{integrator}" solver="{solver}" '
                       f'tolerance="{tolerance}" iterations="{iterations}" timestep="{1 / 60 / substeps:.12g}"/>')
        self.parts, self.soft, self.rigid, self.targets = [], [], [], {}

    def add_plane(self, friction=1.0):
        self.parts.append(
            f'<geom type="plane" size="0 0 1" zaxis="0 1 0" priority="1" friction="{friction} 0.005 0.0001"/>')

    def add_soft(self, body):
        name, material = f"flex{len(self.soft)}", body.material
        if body.swells != 1:
            raise Unsupported("its soft bodies have no other volume at rest")
        dof = "full" if self.cells is None else {1: "trilinear", 2: "quadratic"}[self.order]
        if self.cells is None:
            held = np.flatnonzero(body.held)
            pins = f'<pin id="{numbers(held)}"/>' if len(held) else ""
            cells = ""
        else:
            pins = self.pins_of(body)
            cells = f' cellcount="{numbers(self.cells)}"'
            if body.led is not None:
                raise Unsupported("nodes of a grid of cells are not those of the tets")
        contact = '' if body.contact else ' contype="0" conaffinity="0"'
        self.parts.append(
            f'<flexcomp name="{name}" type="direct" dim="3" dof="{dof}"{cells} radius="{RADIUS}" '
            f'mass="{body.masses.sum()}" point="{numbers(body.nodes)}" element="{numbers(body.tets)}">'
            f'<elasticity young="{material.youngs_modulus}" poisson="{material.poisson_ratio}" '
            f'damping="{material.damping}"{self.yield_of(material)}/>'
            f'<contact selfcollide="{"auto" if body.self_contact else "none"}"'
            f' friction="{material.friction} 0.005 0.0001"{contact}/>{pins}</flexcomp>')
        self.soft.append(body)
        return len(self.soft) - 1

    def yield_of(self, material):
        if material.yield_strain is None:
            return ""
        return f' yield="{2 / 3 * (1 + material.poisson_ratio) * material.yield_strain:.9g}"'

    def pins_of(self, body):
        """Pins of the grid's nodes where the body is held: on the side of its box that all held nodes lie on."""
        if not body.held.any():
            return ""
        low = body.nodes.min(0)
        if np.abs(body.nodes[body.held, 0] - low[0]).max() > 1e-9:
            raise Unsupported("a grid of cells is held at its nodes, of which none is where the body is held")
        across = [self.order * n for n in self.cells[1:]]
        return f'<pin gridrange="0 0 0 0 {across[0]} {across[1]}"/>'

    def add_rigid(self, rigid):
        name = f"rigid{len(self.rigid)}"
        shape = "box" if rigid.shape == "box" else "sphere"
        x, y, z, w = rigid.rotation
        joint = "<freejoint/>" if rigid.mass else ""
        mass = f' mass="{rigid.mass}"' if rigid.mass else ""
        if rigid.moved:  # bodies that are placed have no velocity in contact: heavy ones, on slides, are pushed
            joint = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))
            mass = f' mass="{HEAVY}"'
        self.parts.append(
            f'<body name="{name}" pos="{numbers(rigid.position)}" quat="{numbers((w, x, y, z))}" '
            f'gravcomp="{int(rigid.moved)}">{joint}'
            f'<geom type="{shape}" size="{numbers(rigid.size)}"{mass} priority="1" '
            f'friction="{rigid.friction} 0.005 0.0001"/>'
            '</body>')
        self.rigid.append(rigid)
        return name

    def start(self):
        world = "\n".join(self.parts)
        self.model = mujoco.MjModel.from_xml_string(
            f'<mujoco>{self.option}<size memory="200M"/><worldbody>{world}</worldbody></mujoco>')
        self.data = mujoco.MjData(self.model)
        if self.cells is None:
            for k, body in enumerate(self.soft):
                bodies = self.model.flex_vertbodyid[self.rows_of(k)]
                masses = body.masses if body.led is None else np.where(body.led, HEAVY, body.masses)
                self.model.body_mass[bodies[bodies > 0]] = masses[bodies > 0]
            mujoco.mj_setConst(self.model, self.data)
        mujoco.mj_forward(self.model, self.data)
        for k, rigid in enumerate(self.rigid):
            if rigid.mass:
                at = self.model.jnt_dofadr[self.model.body(f"rigid{k}").jntadr[0]]
                self.data.qvel[at : at + 3] = rigid.velocity

    def rows_of(self, handle):
        first = self.model.flex_vertadr[handle]
        return slice(first, first + self.model.flex_vertnum[handle])

    def move(self, handle, position):
        self.targets[self.model.body(handle).id] = np.asarray(position, float)

    def lead(self, handle, positions):
        self.targets |= dict(zip(self.led_of(handle), np.asarray(positions, float)))

    def led_of(self, handle):
        return self.model.flex_vertbodyid[self.rows_of(handle)][self.soft[handle].led]

    def release(self, handle):
        bodies = self.led_of(handle)
        self.model.body_mass[bodies] = self.soft[handle].masses[self.soft[handle].led]
        mujoco.mj_setConst(self.model, mujoco.MjData(self.model))
        for body in bodies:
            del self.targets[body]

    def set_velocities(self, handle, rows):
        if self.cells is not None:
            raise Unsupported("velocities of a grid of cells are not those of the tets' nodes")
        for body, velocity in zip(self.model.flex_vertbodyid[self.rows_of(handle)], rows):
            if body > 0:
                at = self.model.body_dofadr[body]
                self.data.qvel[at : at + 3] = velocity

    def step(self, dt):
        self.model.opt.timestep = dt / self.substeps
        for left in range(self.substeps if self.targets else 0, 0, -1):
            for row, target in self.targets.items():
                body = self.model.body(row)
                at, way = self.model.jnt_dofadr[body.jntadr[0]], self.model.jnt_qposadr[body.jntadr[0]]
                missing = target - body.pos - self.data.qpos[way : way + 3]
                self.data.qvel[at : at + 3] = missing / (left * self.model.opt.timestep)
            mujoco.mj_step(self.model, self.data)
        if not self.targets:
            mujoco.mj_step(self.model, self.data, self.substeps)
        if self.data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number:  # MuJoCo then starts again from rest
            raise FloatingPointError("MuJoCo found accelerations that are not finite, and reset itself")
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_flex(self.model, self.data)

    def nodes(self, handle):
        return np.array(self.data.flexvert_xpos[self.rows_of(handle)])

    def velocities(self, handle):
        rows = np.zeros((len(self.soft[handle].nodes), 3))
        for k, body in enumerate(self.model.flex_vertbodyid[self.rows_of(handle)]):
            if body > 0:
                at = self.model.body_dofadr[body]
                rows[k] = self.data.qvel[at : at + 3]
        return rows

    def surface(self, handle):
        if self.soft[handle].skin:
            raise Unsupported("a flex has no second, finer surface")
        return self.nodes(handle)

    def pose(self, handle):
        body = self.data.body(handle)
        w, x, y, z = body.xquat
        return np.array(body.xpos), np.array([x, y, z, w])

    def asleep(self, handle):
        return False
