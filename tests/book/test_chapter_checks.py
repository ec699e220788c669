"""A reader who changes a sign in a chapter's code sees a check fail: the checks on the page can tell."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sampling import some

CELL = re.compile(r"^```\{code-cell\}[^\n]*\n(.*?)^```", re.DOTALL | re.MULTILINE)

CHANGES = {
    "why": [
        ("moved[i - 1] += 0.25", "moved[i - 2] += 0.25"),
        ("pen = elbow + sp.Matrix([a2 * sp.cos(both)", "pen = elbow + sp.Matrix([a2 * sp.cos(theta2)"),
        ("2 * to_the_pen - first, -second", "2 * to_the_pen - first, second"),
        ("A2 = Rz(theta2) * Tx(a2)", "A2 = Tx(a2) * Rz(theta2)"),
        ("all_three = theta1 + theta2 + theta3", "all_three = theta1 + theta2 - theta3"),
        ("Tz(h) * Rx(sp.pi / 2)", "Tz(h) * Rx(-sp.pi / 2)"),
        ("T = T @ drawing_arm.A(i, q)", "T = drawing_arm.A(i, q) @ T"),
        ("* Rz(-sp.pi / 2)\nB2", "* Rz(sp.pi / 2)\nB2"),
        ("right = pen_if(first + second)", "right = pen_if(first - second)"),
    ],
    "classic": [
        ("x_i = R[:, 0]", "x_i = R[:, 1]"),
        ("along_1 = w_1 + t * c - s", "along_1 = w_1 + t * c + s"),
        ("np.arctan2(np.cross(start, end) @ about", "np.arctan2(np.cross(end, start) @ about"),
        ("a = way @ x_after", "a = -way @ x_after"),
        ("turned = frame_0 @ Rz(theta_1)", "turned = frame_0 @ Rz(-theta_1)"),
        ("pushed = lifted @ Tx(a_1)", "pushed = lifted @ Tx(-a_1)"),
        ("across = sp.Matrix([-sp.sin(theta)", "across = sp.Matrix([sp.sin(theta)"),
        ("position = d * z_before + a * n", "position = d * z_before - a * n"),
        ("flipped = classic(theta + sp.pi, d, -a", "flipped = classic(theta + sp.pi, d, a"),
        ("second = classic(-theta_2, -d_2", "second = classic(-theta_2, d_2"),
        ("return moved * step * inverse(moved)", "return inverse(moved) * step * moved"),
        (
            "frames.append(frame(x, after.direction, foot_after))",
            "frames.append(frame(x, after.direction, foot_before))",
        ),
        ("            theta = theta + value", "            theta = theta - value"),
        ("level = Axis([0, 10, 30]", "level = Axis([5, 10, 30]"),
        ("early = Tz(d) * Tx(a) * Rz(theta)", "early = Tz(d) * Rz(theta) * Tx(a)"),
        ("arm.frames([0, 0.5, 0])", "arm.frames([0, 0, 0.5])"),
    ],
    "base_tool": [
        ("Tz(0.67183) @ Rz(-90 * degrees)\n\nx_0", "Tz(0.67183) @ Rz(90 * degrees)\n\nx_0"),
        ("np.allclose(X, Z @ T6 @ E)", "np.allclose(X, E @ T6 @ Z)"),
        ("X_wanted = part @ Rx(180 * degrees)", "X_wanted = part @ Rx(90 * degrees)"),
        ("T6_wanted = inverse(Z) @ X_wanted", "T6_wanted = Z @ X_wanted"),
        ("T6_changed = T6_wanted @ E @ inverse(E_longer)", "T6_changed = T6_wanted @ E_longer @ inverse(E)"),
        ("np.allclose(X @ inverse(E) @ inverse(T6), Z)", "np.allclose(X @ inverse(T6) @ inverse(E), Z)"),
        ("right = np.concatenate([-T[:3, 3]", "right = np.concatenate([T[:3, 3]"),
        ("z = np.cross(x, on_the_top - corner)", "z = np.cross(on_the_top - corner, x)"),
        ("row_alone = Rz(theta_1 + phi) * Tz(d_1 + h)", "row_alone = Rz(theta_1 - phi) * Tz(d_1 + h)"),
    ],
    "pa10": [
        ("frame(x, y, E), frame(x, z, E),", "frame(x, -y, E), frame(x, z, E),"),
        ("frame(x, y, W), frame(x, z, W),", "frame(x, y, E), frame(x, z, W),"),
        ("Rx(-quarter) * Rz(theta[1]) * Rx(quarter)", "Rx(quarter) * Rz(theta[1]) * Rx(-quarter)"),
        ("elbow = Ry(q[3])", "elbow = Ry(-q[3])"),
        ("assert between == Ty(-L)", "assert between == Ty(L)"),
        ("Revolute(a=l1, offset=-90 * degrees)", "Revolute(a=l1, offset=90 * degrees)"),
        ("W = T7[:3, 3] - f * T7[:3, 2]", "W = T7[:3, 3] + f * T7[:3, 2]"),
        ("m = (D**2 + l1**2 - l2**2) / (2 * D)\nr = np", "m = (D**2 - l1**2 + l2**2) / (2 * D)\nr = np"),
        ("np.arctan2(remains[2, 1], -remains[2, 0])", "np.arctan2(remains[2, 1], remains[2, 0])"),
    ],
    "prismatic": [
        (
            "            Tz(delta) * classic(theta, d, a, alpha))",
            "            Tz(-delta) * classic(theta, d, a, alpha))",
        ),
        ("z_2 = stanford.frames(q)[2][:3, 2]", "z_2 = stanford.frames(q)[1][:3, 2]"),
        ("Prismatic(theta=-90 * degrees),          #", "Prismatic(theta=90 * degrees),          #"),
        ("d_3 * C1 * S2 - d_2 * S1", "d_3 * C1 * S2 + d_2 * S1"),
        ('Axis(S, z, "P"),', "Axis(S, z),"),
        ("* Rz(-theta_4) * Rx(sp.pi)", "* Rz(theta_4) * Rx(sp.pi)"),
        ("cobra_with(d4=-0.387),", "cobra_with(d4=0.387),"),
        ("q_table = q_sensor + [0, 0, 12 * inch", "q_table = q_sensor - [0, 0, 12 * inch"),
        ("signs = np.array([1, -1, 1, 1, 1, 1])", "signs = np.array([1, 1, 1, 1, 1, 1])"),
        ("row2=dict(d=0.154 - 0.0203)", "row2=dict(d=0.154 + 0.0203)"),
    ],
    "transforms": [
        ("[sp.cos(theta), sp.sin(theta), 0]", "[sp.cos(theta), -sp.sin(theta), 0]"),
        ('[[0, 0, 1], [1, 0, 0], [0, 1, 0]]),\n    "y up"', '[[0, 0, 1], [1, 0, 0], [0, -1, 0]]),\n    "y up"'),
        ("go_then_turn = forward @ left", "go_then_turn = left @ forward"),
        ("as_seen_from_outside = T @ M @ inverse(T)", "as_seen_from_outside = inverse(T) @ M @ T"),
        ("back[:3, 3] = -R.T @ p", "back[:3, 3] = -p"),
        ("cube_in_camera = Ty(-200)", "cube_in_camera = Ty(200)"),
        ("product = product @ arm.A(i, q)", "product = arm.A(i, q) @ product"),
        ("if np.linalg.det(R) < 0:", "if np.linalg.det(R) < -2:"),
        ("four_steps = Rz(theta) * Tz(d)", "four_steps = Rz(theta) * Tx(d)"),
    ],
    "placing": [
        ("return a, np.arctan2(sine, cosine)", "return a, np.arctan2(-sine, cosine)"),
        ("origins = [O_1, O_2, O_3, O_4]", "origins = [O_1, O_1, O_3, O_4]"),
        ("np.cross(z[2], z[3]),           #", "np.cross(z[3], z[2]),           #"),
        ("changed(arm, {2: dict(d=30), 3: dict(d=0)})", "changed(arm, {2: dict(d=30), 3: dict(d=60)})"),
        ("classic(t2, d2 + t, a2, sp.pi) * classic(t3, d3 + t", "classic(t2, d2 + t, a2, sp.pi) * classic(t3, d3 - t"),
        ("4: dict(theta=theta_4 - half_turn)", "4: dict(theta=theta_4)"),
        ("{2: dict(sign=-1)})", "{2: dict(sign=1)})"),
        ("reached = frames[1] @ Rz(theta) @ Tx(a) @ Rx(alpha)", "reached = frames[1] @ Rz(theta) @ Tx(a) @ Rx(-alpha)"),
    ],
    "modified": [
        ("    pose[:3, 3] = normal.before       #", "    pose[:3, 3] = normal.after        #"),
        ("x_before = sp.Matrix([1, 0, 0])", "x_before = sp.Matrix([0, 0, 1])"),
        ("way @ x_before,\n", "-way @ x_before,\n"),
        ("crossed = twisted @ Tx(a_1)", "crossed = twisted @ Tz(a_1)"),
        ("A = Rx(alpha) * Tx(a) * Rz(theta)", "A = Rx(alpha) * Tx(a) * Rz(-theta)"),
        ("sp.Matrix([[-sp.sin(alpha)]])", "sp.Matrix([[sp.sin(alpha)]])"),
        ("walk = a * x_before + d *", "walk = a * x_before - d *"),
        ("back = classic(-theta, -d, -a, -alpha)", "back = classic(-theta, -d, a, -alpha)"),
        ("mended = Rx(alpha) * Tx(a) * Rz(theta) * Tz(d)", "mended = Rx(alpha) * Tx(a) * Rz(theta) * Tx(d)"),
        ("        pose = pose @ modified(joint.alpha, joint.a", "        pose = pose @ modified(-joint.alpha, joint.a"),
    ],
    "both": [
        ("    return Tx(joint.a) @ Rx(joint.alpha)", "    return Tx(joint.a) @ Rx(-joint.alpha)"),
        ("links = [(0, 0)] + [(joint.a, joint.alpha) for", "links = [(0, 0)] + [(joint.a, -joint.alpha) for"),
        ("[0, 426, -90, 0], [0, 0, 90, 0]", "[0, 426, 90, 0], [0, 0, 90, 0]"),
        ("np.allclose(back.base, Tx(50) @ Rx(90 * degrees))", "np.allclose(back.base, Tx(50) @ Rx(-90 * degrees))"),
        ("F_classic[i], F_modified[i] @ X(joint)", "F_modified[i], F_classic[i] @ X(joint)"),
        ("0.333 + 0.316 + 0.384 - 0.107", "0.333 + 0.316 + 0.384 + 0.107"),
        ("np.linalg.inv(X(arm.joints[1])) @ camera", "X(arm.joints[1]) @ camera"),
    ],
    "quickshot": [
        ("Axis([180, 28, 100], z)", "Axis([180, 20, 100], z)"),
        ("frame(x, y, [20, 0, 100])", "frame(x, -y, [20, 0, 100])"),
        ("row1 = Revolute(d=100, a=20, alpha=-90", "row1 = Revolute(d=100, a=20, alpha=+90"),
        ("Rz(theta2 + theta3)\n", "Rz(theta2 - theta3)\n"),
        ("h = 100 - 160 * sp", "h = 100 + 160 * sp"),
        ("s1 * c4 * (s2 * c3 + c2 * s3) + c1 * s4,\n", "s1 * c4 * (c2 * c3 - s2 * s3) + c1 * s4,\n"),
        ("X = Z @ arm.T(0, 4, angles) @ E", "X = E @ arm.T(0, 4, angles) @ Z"),
        ("Revolute(d=28, a=160, alpha=0)", "Revolute(d=-28, a=160, alpha=0)"),
        ("Revolute(d=0, a=160, alpha=0, offset=180", "Revolute(d=0, a=160, alpha=0, offset=90"),
        ("Revolute(d=-28, a=0, alpha=-90", "Revolute(d=28, a=0, alpha=-90"),
    ],
    "puma560": [
        ("Axis(wrist, -z),            # 4", "Axis(wrist, z),             # 4"),
        ("frame(x, y, [A2, D3, 0]),   # 3", "frame(x, y, [A2, -D3, 0]),  # 3"),
        ("S23 = C2 * S3 + S2 * C3", "S23 = C2 * S3 - S2 * C3"),
        ("r = a2 * C2 + a3 * cosine - d4 * sine", "r = a2 * C2 + a3 * cosine + d4 * sine"),
        ("a=-joints[k].a, alpha=-joints[k].alpha", "a=joints[k].a, alpha=-joints[k].alpha"),
        ("shift = np.array([180, 180,", "shift = np.array([180, 0,"),
        ("a2=row_3.a, a3=-row_4.a, d3=row_2.d + row_3.d", "a2=row_3.a, a3=-row_4.a, d3=row_2.d - row_3.d"),
        ("theta5: -theta5,", "theta5: theta5,"),
        ('{"alpha_3", "a_3"}, {"alpha_4"}', '{"alpha_3"}, {"alpha_4"}'),
    ],
    "data_sheet": [
        ("Rz(yaw) @ Ry(pitch) @ Rx(roll))", "Rx(roll) @ Ry(pitch) @ Rz(yaw))"),
        ("pose = pose @ joint.origin", "pose = joint.origin @ pose"),
        ("direction = pose[:3, :3] @ joint.axis", "direction = joint.axis"),
        ('<origin xyz="0 -0.1197 0.425"/>', '<origin xyz="0 0.1197 0.425"/>'),
        ('("joint5", "revolute", "link4", "link5", "-0.0825', '("joint5", "revolute", "link4", "link5", "0.0825'),
        ("Axis(E, x), Axis(W, y), Axis(W, x),", "Axis(E, -x), Axis(W, y), Axis(W, x),"),
        ("ours = irb.fk(verdict.offsets + q)", "ours = irb.fk(q)"),
        ("hand, flange @ Rz(-45 * degrees)", "hand, flange @ Rz(45 * degrees)"),
    ],
    "beyond": [
        ("np.cross(z, p - O), *z])", "np.cross(p - O, z), *z])"),
        ('at = i - 1 if arm.convention == "classic" else i', "at = i"),
        ("columns.append([*z, 0, 0, 0])", "columns.append([0, 0, 0, *z])"),
        ("np.arctan2(y, x) - turned", "np.arctan2(y, x) + turned"),
        ("theta1 = np.arctan2(y, x) - np.arctan2(d3, r)", "theta1 = np.arctan2(y, x) + np.arctan2(d3, r)"),
        ("theta2 = np.arctan2(-z, r)", "theta2 = np.arctan2(z, r)"),
        ("np.arctan2(R[2, 2], -R[0, 2])", "np.arctan2(R[2, 2], R[0, 2])"),
        ("S[:3, 3] = -np.cross(u, c)", "S[:3, 3] = np.cross(u, c)"),
        ("turns = [q, np.pi - q, q, np.pi - q]", "turns = [q, np.pi - q, -q, np.pi - q]"),
    ],
    "proofreading": [
        ("    [-S5, -C5, 0, 0],\n", "    [S5, C5, 0, 0],\n"),
        ("T_45 = Rx(sp.pi / 2)", "T_45 = Rx(-sp.pi / 2)"),
        ("n_y = S1 * C4 * (C2 * C3 - S2 * S3)", "n_y = S1 * C4 * (C2 * C3 + S2 * S3)"),
        ("    + S1 * (S4 * C5 * C6 + C4 * S6),", "    - S1 * (S4 * C5 * C6 + C4 * S6),"),
        ("replace(d=-d4)", "replace(d=d4)"),
        ("- a2 * S2 - d4 * C23", "- a2 * S2 + d4 * C23"),
        ("aside = Ty(20) @ Tz(100)", "aside = Tx(20) @ Tz(100)"),
        ("sp.atan2(-link[1, 2], link[2, 2])", "sp.atan2(link[1, 2], link[2, 2])"),
        ("first_row.a * np.cos(turn), first_row.a", "first_row.a * np.cos(turn), -first_row.a"),
        ("as_the_text_says = O_1 - O_0 ", "as_the_text_says = O_0 - O_1 "),
        ("Prismatic(theta=0.3, **link)):", 'Prismatic(theta=0.3, **link | {"a": 0.2})):'),
        ("shear[2, 0] = 2.0 ", "shear[2, 3] = 2.0 "),
        ("(-S1 * bracket, S1 * bracket),", "(S1 * bracket, -S1 * bracket),"),
        ('"quickshot": (S2 * C3 + C2 * S3,', '"quickshot": (S2 * C3 - C2 * S3,'),
    ],
}


def cells(chapter: str) -> list[str]:
    """Return the code of a chapter, cell by cell, without options."""
    return [re.sub(r"^:tags:.*\n", "", code) for code in CELL.findall(chapter)]


def run(chapter: str) -> None:
    """Run the code of a chapter."""
    names: dict[str, Any] = {}
    with np.printoptions():  # chapters set their own
        for code in cells(chapter):
            exec(compile(code, "<chapter>", "exec"), names)


@pytest.mark.parametrize("chapter", CHANGES)
def test_a_changed_sign_fails(root: Path, chapter: str, capsys: pytest.CaptureFixture[str]) -> None:
    text = (root / "book" / f"{chapter}.md").read_text("utf-8")
    run(text)
    for right, _ in CHANGES[chapter]:
        assert text.count(right) == 1, f"book/{chapter}.md has {text.count(right)} places with {right!r}"
    for right, changed in some(CHANGES[chapter], 4, chapter):
        with pytest.raises(AssertionError):
            run(text.replace(right, changed))
    capsys.readouterr()
