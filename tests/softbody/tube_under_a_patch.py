#!/usr/bin/env python3
"""A solid tube pressed on a patch, by CalculiX: the numbers of shell_test.cpp.

    apt-get install calculix-ccx
    tests/softbody/tube_under_a_patch.py [AROUND ROWS LAYERS]

Radius 12 to 13.5 mm, 200 mm long, both ends held; E 1200 kPa, nu 0.49, small displacements; 1 mN outward, spread evenly
over 30 degrees of 6.7 mm at mid-length, from inside.  20-node bricks with reduced integration.  Prints how far the wall
goes outward, mm, the mean of what lies across it: at 100, 110, 120, 140, 160 mm above the middle of the patch, then at
30, 60, 90, 135 and 180 degrees beside it.
"""
import math
import os
import subprocess
import sys
import tempfile

AROUND, ROWS, LAYERS = (int(a) for a in sys.argv[1:4]) if len(sys.argv) > 3 else (48, 120, 1)
INNER_MM, THICKNESS_MM, LENGTH_MM = 12.0, 1.5, 200.0
YOUNG_KPA, POISSON, FORCE_MN = 1200.0, 0.49, 1.0  # kPa are mN/mm2
HALF_ANGLE, HALF_HEIGHT_MM = math.radians(15.0), 10.0 / 3.0


def write_model(path):
    """Returns the numbers of the nodes, by (half columns, half rows, half layers)."""
    number, nodes, elements, pressed = {}, [], [], []

    def node(i, j, k):
        key = (i % (2 * AROUND), j, k)
        if key not in number:
            angle, radius = math.pi * key[0] / AROUND, INNER_MM + THICKNESS_MM * k / (2 * LAYERS)
            number[key] = len(nodes) + 1
            nodes.append((radius * math.cos(angle), radius * math.sin(angle), LENGTH_MM * j / (2 * ROWS)))
        return number[key]

    corners, middles = [(0, 0), (2, 0), (2, 2), (0, 2)], [(1, 0), (2, 1), (1, 2), (0, 1)]
    for j in range(ROWS):
        for i in range(AROUND):
            for k in range(LAYERS):
                at = lambda places, layer: [node(2 * i + a, 2 * j + b, 2 * k + layer) for a, b in places]
                elements.append(at(corners, 0) + at(corners, 2) + at(middles, 0) + at(middles, 2) + at(corners, 1))
                angle = math.remainder(2.0 * math.pi * (i + 0.5) / AROUND, 2.0 * math.pi)
                height = LENGTH_MM * ((j + 0.5) / ROWS - 0.5)
                if k == 0 and abs(angle) < HALF_ANGLE and abs(height) < HALF_HEIGHT_MM:
                    pressed.append(len(elements))
    pressure = FORCE_MN / (INNER_MM * 2.0 * math.sin(HALF_ANGLE) * 2.0 * HALF_HEIGHT_MM)
    with open(path, "w") as out:
        out.write("*NODE,NSET=ALL\n")
        for n, place in enumerate(nodes, 1):
            out.write("%d,%.9g,%.9g,%.9g\n" % (n, *place))
        out.write("*ELEMENT,TYPE=C3D20R,ELSET=WALL\n")
        for e, n in enumerate(elements, 1):
            words = [str(e)] + [str(a) for a in n]
            out.write(",".join(words[:12]) + ",\n" + ",".join(words[12:]) + "\n")
        held = [str(n) for (_, j, _), n in number.items() if j in (0, 2 * ROWS)]
        out.write("*NSET,NSET=ENDS\n" + "\n".join(held) + "\n")
        out.write(f"*MATERIAL,NAME=M\n*ELASTIC\n{YOUNG_KPA},{POISSON}\n*SOLID SECTION,ELSET=WALL,MATERIAL=M\n")
        out.write("*BOUNDARY\nENDS,1,3\n*STEP\n*STATIC\n*DLOAD\n")
        for e in pressed:
            out.write(f"{e},P1,{pressure}\n")
        out.write("*NODE PRINT,NSET=ALL\nU\n*END STEP\n")
    return number


with tempfile.TemporaryDirectory() as folder:
    number = write_model(os.path.join(folder, "tube.inp"))
    subprocess.run(["ccx", "tube"], cwd=folder, stdout=subprocess.DEVNULL, check=True)
    moved = {}
    with open(os.path.join(folder, "tube.dat")) as lines:
        for words in (line.split() for line in lines):
            if len(words) == 4 and words[0].isdigit():
                moved[int(words[0])] = [float(w) for w in words[1:]]
for degrees, z in [(0, z) for z in (100, 110, 120, 140, 160)] + [(a, 100) for a in (30, 60, 90, 135, 180)]:
    i, j, angle = round(degrees / 180 * AROUND), round(2 * ROWS * z / LENGTH_MM), math.radians(degrees)
    across = [moved[number[i, j, k]] for k in range(2 * LAYERS + 1) if (i, j, k) in number]
    outward = [u[0] * math.cos(angle) + u[1] * math.sin(angle) for u in across]
    print("%3d degrees, %3d mm: %.5f mm" % (degrees, z, sum(outward) / len(outward)))
