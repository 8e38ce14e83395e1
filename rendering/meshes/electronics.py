"""Screens, computers, telephones and what makes sound."""

from __future__ import annotations

from hearth.rendering.meshes.joinery import knob
from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, shift, turn
from hearth.rendering.meshes.paint import BLACK, CHROME, DARK, GREY, WALNUT, WHITE, Paint
from hearth.rendering.meshes.shapes import arc, ball, block, box, cushion, cylinder, panel, rod, tube
from hearth.rendering.pictures import SHOWS

SCREEN_OFF = Paint("#14171b", shine=0.9)
LIT = 0.9


def _screen(look: Look, picture: str) -> Paint:
    return Paint("#ffffff", picture, glow=LIT) if look.on else SCREEN_OFF


def television(look: Look) -> Mesh:
    """A flat television on a foot; shows a programme when it is on."""
    w, h, d = look.size
    foot = min(0.07, h * 0.12)
    t = min(0.05, d)
    frame = block(-w / 2, w / 2, foot, h, -t / 2, t / 2, BLACK)
    picture = panel(
        (0, (foot + h) / 2, t / 2 + 0.002), w - 0.04, h - foot - 0.04, _screen(look, look.pick(SHOWS, "show"))
    )
    stand = block(-w * 0.22, w * 0.22, 0, 0.015, -d / 2, d / 2, DARK) + block(
        -0.04, 0.04, 0.015, foot, -0.02, 0.02, DARK
    )
    led = panel(
        (w * 0.45, foot + 0.01, t / 2 + 0.003), 0.012, 0.008, Paint("#ff4030" if not look.on else "#60ff80", glow=1.0)
    )
    return join((frame, picture, stand, led))


def monitor(look: Look) -> Mesh:
    """A computer screen on a stand."""
    w, h, d = look.size
    t, low = 0.03, h * 0.24
    frame = block(-w / 2, w / 2, low, h, -t / 2, t / 2, BLACK)
    picture = panel((0, (low + h) / 2, t / 2 + 0.002), w - 0.025, h - low - 0.03, _screen(look, "desktop"))
    neck = block(-0.03, 0.03, 0.01, low + 0.05, -t / 2 - 0.02, -t / 2, GREY)
    foot = cushion((0, 0.008, 0), (w * 0.42, 0.016, d), GREY, 0.8, 3)
    return join((frame, picture, neck, foot))


def computer(look: Look) -> Mesh:
    """A computer: a tower where the box is upright, else a screen."""
    w, h, d = look.size
    if w > h * 0.8:
        return monitor(look)
    case = block(-w / 2, w / 2, 0, h, -d / 2, d / 2 - 0.01, DARK)
    front = block(-w / 2, w / 2, 0, h, d / 2 - 0.01, d / 2 - 0.003, BLACK)
    light = Paint("#6fd0ff", glow=1.4) if look.on else GREY
    slots = [panel((0, h * y, d / 2 - 0.002), w * 0.8, 0.03, GREY) for y in (0.86, 0.76)]
    button = shift(turn(cylinder((0, 0, 0), 0.016, 0.006, light), "x", 90), 0, h * 0.62, d / 2 - 0.004)
    grill = [panel((0, h * (0.1 + 0.05 * k), d / 2 - 0.002), w * 0.7, 0.01, GREY) for k in range(7)]
    return join([case, front, *slots, button, *grill])


def laptop(look: Look) -> Mesh:
    """A laptop, open: keyboard and screen."""
    w, h, d = look.size
    shell = Paint(look.pick(("#b9bcc0", "#3a3d42", "#d5cfc4"), "shell"), shine=0.4)
    base = block(-w / 2, w / 2, 0, 0.016, -d / 2, d / 2, shell) + panel(
        (0, 0.0172, -d * 0.08), w * 0.9, d * 0.5, Paint("#ffffff", "keyboard"), "+y"
    )
    pad = panel((0, 0.0175, d * 0.34), w * 0.3, d * 0.22, GREY, "+y")
    lid = block(-w / 2, w / 2, 0, h - 0.02, -0.006, 0.006, shell) + panel(
        (0, (h - 0.02) / 2, 0.0075), w * 0.93, (h - 0.02) * 0.88, _screen(look, "desktop")
    )
    return join((base, pad, shift(turn(lid, "x", -14), 0, 0.014, -d / 2 + 0.02)))


def keyboard(look: Look) -> Mesh:
    """A computer keyboard."""
    w, h, d = look.size
    return turn(
        block(-w / 2, w / 2, 0, h * 0.7, -d / 2, d / 2, DARK)
        + panel((0, h * 0.7 + 0.001, 0), w * 0.97, d * 0.92, Paint("#ffffff", "keyboard"), "+y"),
        "x",
        2,
    )


def mouse(look: Look) -> Mesh:
    """A computer mouse."""
    w, h, d = look.size
    body = look.tint(Paint(shine=0.4), ("#26282c", "#e6e6e4", "#8a2f2c"))
    return cushion((0, h * 0.45, 0), (w, h * 0.9, d), body, 0.95, 6) + cushion(
        (0, h * 0.86, -d * 0.24), (w * 0.14, h * 0.24, d * 0.18), GREY, 1.0, 3
    )


def phone(look: Look) -> Mesh:
    """A desk telephone with handset, keys and cord."""
    w, h, d = look.size
    body = look.tint(Paint(shine=0.3), ("#2e3035", "#a8342e", "#e8e2d2", "#3d5a4c"))
    base = cushion((0, h * 0.25, 0), (w, h * 0.5, d), body, 0.3, 3)
    keys = [
        box(
            (-w * 0.04 - (k % 3 - 1) * w * 0.17, h * 0.53, -d * 0.16 + (k // 3) * d * 0.16),
            (w * 0.12, h * 0.08, d * 0.1),
            WHITE,
        )
        for k in range(12)
    ]
    x = w * 0.33
    bar = rod((x, h * 0.82, -d * 0.36), (x, h * 0.82, d * 0.36), h * 0.14, body, sides=8)
    ends = [cushion((x, h * 0.68, s * d * 0.38), (w * 0.3, h * 0.5, d * 0.22), body, 0.8, 4) for s in (-1, 1)]
    return join([base, *keys, bar, *ends])


def cellphone(look: Look) -> Mesh:
    """A cellphone lying on its back."""
    w, h, d = look.size
    body = cushion((0, h / 2, 0), (w, h, d), BLACK, 0.5, 3)
    face = Paint("#ffffff", "desktop", glow=LIT) if look.on else Paint("#2a4a6a", shine=0.9)
    return body + panel((0, h + 0.001, 0), w * 0.88, d * 0.86, face, "+y")


def remote(look: Look) -> Mesh:
    """A remote control: a slim bar with buttons."""
    w, h, d = look.size
    body = cushion((0, h / 2, 0), (w, h, d), DARK, 0.5, 3)
    keys = [
        box((-(k % 3 - 1) * w * 0.27, h + 0.001, -d * 0.22 + (k // 3) * d * 0.11), (w * 0.17, h * 0.2, d * 0.06), GREY)
        for k in range(15)
        if k // 3 < 5
    ]
    power = box((-w * 0.25, h + 0.002, -d * 0.38), (w * 0.24, h * 0.25, d * 0.07), Paint("#d8372e"))
    return join([body, *keys, power])


def gamepad(look: Look) -> Mesh:
    """A game controller with two grips and sticks."""
    w, h, d = look.size
    body = look.tint(Paint(shine=0.3), ("#26282c", "#e6e6e4", "#3f77b5"))
    middle = cushion((0, h * 0.5, -d * 0.1), (w * 0.72, h * 0.7, d * 0.6), body, 0.8)
    grips = [
        turn(cushion((s * w * 0.34, h * 0.42, d * 0.1), (w * 0.26, h * 0.8, d * 0.78), body, 0.95), "y", s * 14)
        for s in (-1, 1)
    ]
    sticks = [cylinder((s * w * 0.14, h * 0.8, d * 0.06), w * 0.06, h * 0.2, DARK, sides=10) for s in (-1, 1)]
    keys = [
        ball((-w * 0.3 + x, h * 0.86, -d * 0.14 + z), w * 0.032, Paint(c), 2)
        for x, z, c in ((0, -0.012, "#e0c23a"), (0.012, 0, "#c8463c"), (-0.012, 0, "#3f77b5"), (0, 0.012, "#4f9a5c"))
    ]
    return join([middle, *grips, *sticks, *keys])


def radio(look: Look) -> Mesh:
    """A radio or stereo: speaker cloth, dial, knobs, an aerial or two speakers."""
    w, h, d = look.size
    wide = look.kind == "stereo"
    body = look.tint(WALNUT, ("#6f4528", "#8a2f2c", "#3b5f6b", "#d8cfb8")) if not wide else DARK
    case_ = (
        cushion((0, h * 0.46, 0), (w, h * 0.92 if not wide else h, d), body, 0.15, 3)
        if not wide
        else block(-w / 2, w / 2, 0, h, -d / 2, d / 2, body)
    )
    cones = [
        shift(turn(cylinder((0, 0, 0), min(h, w / 3) * 0.36, 0.006, GREY), "x", 90), x * w, h * 0.45, d / 2)
        for x in ((-0.32, 0.32) if wide else (0.22,))
    ]
    cones += [
        shift(turn(cylinder((0, 0, 0), min(h, w / 3) * 0.16, 0.012, BLACK), "x", 90), x * w, h * 0.45, d / 2)
        for x in ((-0.32, 0.32) if wide else (0.22,))
    ]
    glow = Paint("#ffd27a", glow=1.0) if look.on else Paint("#8a8470")
    dial = panel(
        (-w * 0.22 if not wide else 0, h * 0.62, d / 2 + 0.004), w * (0.42 if not wide else 0.24), h * 0.18, glow
    )
    knobs = [knob(x * w, h * 0.25, d / 2, h * 0.08, CHROME) for x in ((-0.34, -0.12) if not wide else (-0.06, 0.06))]
    aerial = (
        [] if wide else [rod((-w * 0.4, h * 0.85, -d * 0.3), (w * 0.1, h * 0.99, -d * 0.3), 0.004, CHROME, sides=5)]
    )
    return join([case_, *cones, dial, *knobs, *aerial])


def player(look: Look) -> Mesh:
    """A flat box under a television: disc player or console."""
    w, h, d = look.size
    body = block(
        -w / 2,
        w / 2,
        h * 0.12,
        h,
        -d / 2,
        d / 2,
        BLACK if look.kind != "console" else look.tint(WHITE, ("#e6e6e4", "#2c2f36")),
    )
    slot = panel((w * 0.1, h * 0.62, d / 2 + 0.001), w * 0.5, h * 0.1, GREY)
    light = Paint("#6fd0ff", glow=1.4) if look.on else GREY
    led = panel((-w * 0.36, h * 0.6, d / 2 + 0.002), w * 0.1, h * 0.2, light)
    foot = [cylinder((x * w, 0, z * d), 0.015, h * 0.12, DARK, sides=8) for x in (-0.4, 0.4) for z in (-0.4, 0.4)]
    return join([body, slot, led, *foot])


def printer(look: Look) -> Mesh:
    """A printer with paper behind and a sheet coming out."""
    w, h, d = look.size
    body = look.tint(WHITE, ("#d9d9d6", "#3a3d42"))
    low = cushion((0, h * 0.32, d * 0.04), (w, h * 0.62, d * 0.9), body, 0.15, 3)
    tray = turn(
        block(-w * 0.32, w * 0.32, h * 0.55, h * 0.98, -d * 0.32, -d * 0.31, Paint("#f5f2e8")),
        "x",
        -14,
        (0, h * 0.55, -d * 0.32),
    )
    sheet = block(-w * 0.3, w * 0.3, h * 0.2, h * 0.21, d * 0.4, d * 0.5, Paint("#f5f2e8"))
    mouth = block(-w * 0.36, w * 0.36, h * 0.14, h * 0.32, d * 0.48, d * 0.495, BLACK)
    keys = [
        box((w * (0.2 + 0.08 * k), h * 0.64, d * 0.28), (0.02, 0.008, 0.02), Paint(c, glow=0.6 * look.on))
        for k, c in enumerate(("#60d080", "#d0d0d0", "#d07050"))
    ]
    return join([low, tray, sheet, mouth, *keys])


def shredder(look: Look) -> Mesh:
    """A paper shredder on its bin."""
    w, h, d = look.size
    tub = block(-w * 0.46, w * 0.46, 0, h * 0.76, -d * 0.45, d * 0.45, GREY)
    head = block(-w / 2, w / 2, h * 0.76, h, -d / 2, d / 2, BLACK)
    slot = panel((0, h + 0.001, 0), w * 0.7, 0.02, GREY, "+y")
    paper = block(-w * 0.3, w * 0.3, h * 0.9, h * 1.0, -0.002, 0.002, Paint("#f5f2e8"))
    window = panel((0, h * 0.4, d * 0.451), w * 0.5, h * 0.3, Paint("#d9d9cf", "checks", 20))
    return join((tub, head, slot, paper, window))


def headset(look: Look) -> Mesh:
    """Headphones lying down: a band in a bow towards -z, and an ear cup at each of its ends."""
    w, h, d = look.size
    thick = min(h * 0.2, 0.012)
    r = min(w / 2, d * 0.62) - thick
    front = d / 2 - r * 0.35
    band = tube(arc((0, h * 0.5, front), r, 180, 360, "xz", 12), thick, DARK, 6)
    paint = look.tint(BLACK, ("#26282c", "#c8463c", "#e6e6e4"))
    cups = []
    for side in (-1, 1):
        cup = turn(cylinder((0, 0, 0), min(h * 0.5, r * 0.42), r * 0.22, paint, sides=16), "z", 90 * side)
        ear = turn(cylinder((0, 0, 0), min(h * 0.4, r * 0.34), r * 0.3, DARK, sides=16), "z", 90 * side)
        cups += [shift(cup, side * (r + thick), h * 0.5, front), shift(ear, side * (r - thick), h * 0.5, front)]
    return join([band, *cups])


def wall_switch(look: Look) -> Mesh:
    """A light switch: a plate with a rocker."""
    w, h, d = look.size
    plate = block(-w / 2, w / 2, 0, h, -d / 2, d * 0.1, WHITE)
    rocker = turn(
        block(-w * 0.2, w * 0.2, h * 0.28, h * 0.72, d * 0.1, d * 0.4, WHITE.tinted("#d8d5cc")),
        "x",
        8 if look.on else -8,
        (0, h / 2, d * 0.1),
    )
    return plate + rocker


def socket(look: Look) -> Mesh:
    """A power socket: a plate with two holes."""
    w, h, d = look.size
    plate = block(-w / 2, w / 2, 0, h, -d / 2, d * 0.2, WHITE)
    ring = shift(
        turn(cylinder((0, 0, 0), w * 0.36, d * 0.2, WHITE.tinted("#dddad2"), sides=16), "x", 90), 0, h / 2, d * 0.2
    )
    holes = [
        shift(turn(cylinder((0, 0, 0), w * 0.07, d * 0.05, BLACK, sides=8), "x", 90), s * w * 0.15, h / 2, d * 0.42)
        for s in (-1, 1)
    ]
    return join([plate, ring, *holes])


def microphone(look: Look) -> Mesh:
    """A microphone lying along z."""
    w, h, d = look.size
    r = min(w, h) / 2
    return rod((0, r, d * 0.5), (0, r, -d * 0.2), r * 0.5, DARK, r * 0.75) + ball(
        (0, r, -d / 2 + r * 1.2), (r, r, r * 1.2), Paint("#8d9095", "wicker", 40.0, shine=0.4)
    )


RECIPES = {
    "television": Recipe(television, (1.05, 0.64, 0.2), states=("ON",)),
    "monitor": Recipe(monitor, (0.54, 0.42, 0.18), states=("ON",)),
    "computer": Recipe(computer, (0.2, 0.42, 0.42), states=("ON",)),
    "laptop": Recipe(laptop, (0.34, 0.24, 0.26), states=("ON",)),
    "keyboard": Recipe(keyboard, (0.44, 0.03, 0.15)),
    "mouse": Recipe(mouse, (0.07, 0.04, 0.11)),
    "phone": Recipe(phone, (0.18, 0.09, 0.2)),
    "cellphone": Recipe(cellphone, (0.08, 0.012, 0.15), states=("ON",)),
    "remote": Recipe(remote, (0.05, 0.02, 0.18)),
    "gamepad": Recipe(gamepad, (0.16, 0.05, 0.11)),
    "radio": Recipe(radio, (0.3, 0.18, 0.12), kinds=("", "stereo"), states=("ON",)),
    "player": Recipe(player, (0.42, 0.07, 0.26), kinds=("", "console"), states=("ON",)),
    "printer": Recipe(printer, (0.42, 0.22, 0.36)),
    "shredder": Recipe(shredder, (0.36, 0.55, 0.26)),
    "headset": Recipe(headset, (0.18, 0.08, 0.18)),
    "wall_switch": Recipe(wall_switch, (0.08, 0.08, 0.02)),
    "socket": Recipe(socket, (0.08, 0.08, 0.02)),
    "microphone": Recipe(microphone, (0.06, 0.06, 0.2)),
}
