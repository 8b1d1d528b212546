// SPDX-License-Identifier: MIT
// Judges a .3dm file with openNURBS (rhino3dm) and prints what it found as JSON.
//
//   node judge_3dm.mjs FILE [--points JSON]
//
// JSON is a file { "objects": [ { "points": [ { "face", "u", "v", "position": [x, y, z] } ] } ] } of
// places on the faces and where they must be. Exit code: 0 read, 2 usage, 3 not readable.
import { existsSync, readFileSync } from 'node:fs';
import rhino3dm from 'rhino3dm';

const usage = 'usage: node judge_3dm.mjs FILE [--points JSON]';

function parseArguments(args) {
    const options = { file: undefined, points: undefined };
    for (let i = 0; i < args.length; ++i) {
        if (args[i] === '--points' && i + 1 < args.length) options.points = args[++i];
        else if (options.file === undefined && !args[i].startsWith('--')) options.file = args[i];
        else return undefined;
    }
    return options.file === undefined ? undefined : options;
}

const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
const list = (collection) => Array.from({ length: collection.count }, (_, i) => collection.get(i));

// Vertices that are not where the edges end are no fault in openNURBS' own eyes.
function endsOffVertices(edges, vertices, trims) {
    let largest = 0;
    for (const { edge, start, end } of trims) {
        const from = edges[edge].pointAtStart, to = edges[edge].pointAtEnd;
        largest = Math.max(largest, distance(from, vertices[start].location),
                           distance(to, vertices[end].location));
    }
    return largest;
}

function judgeBrep(brep, name, expected) {
    const faces = list(brep.faces()), edges = list(brep.edges()), vertices = list(brep.vertices());
    const uses = edges.map(() => []);
    const trims = [];
    let outerLoops = 0;
    for (const face of faces) {
        for (const loop of list(face.loops)) {
            if (loop.loopType === rhino.BrepLoopType.Outer) ++outerLoops;
            for (const trim of list(loop.trims)) {
                // The direction of the edge as the outside sees it.
                uses[trim.edgeIndex].push(trim.isReversed !== face.orientationIsReversed);
                const ends = [trim.startVertexIndex, trim.endVertexIndex];
                if (trim.isReversed) ends.reverse();
                trims.push({ edge: trim.edgeIndex, start: ends[0], end: ends[1] });
            }
        }
    }
    let largest = 0, compared = 0;
    for (const p of expected ?? []) {
        const at = faces[p.face].underlyingSurface().pointAt(p.u, p.v);
        largest = Math.max(largest, distance(at, p.position));
        ++compared;
    }
    const [valid, log] = brep.isValidWithLog;
    const surface = faces[0].underlyingSurface().toNurbsSurface();
    return {
        name,
        isValid: brep.isValid && valid,
        log,
        isSolid: brep.isSolid,
        isManifold: brep.isManifold,
        faces: faces.length,
        edges: edges.length,
        vertices: vertices.length,
        trims: trims.length,
        outerLoops,
        boundaryEdges: uses.filter((u) => u.length === 1).length,
        nonmanifoldEdges: uses.filter((u) => u.length > 2).length,
        inconsistentEdges: uses.filter((u) => u.length === 2 && u[0] === u[1]).length,
        maxEndOffVertex: endsOffVertices(edges, vertices, trims),
        comparedPoints: compared,
        maxPointError: largest,
        surface: {
            order: [surface.orderU, surface.orderV],
            rational: surface.isRational,
            count: [surface.points().countU, surface.points().countV],
            knots: surface.knotsU().toList(),
        },
    };
}

const options = parseArguments(process.argv.slice(2));
if (options === undefined) {
    console.error(usage);
    process.exit(2);
}
const rhino = await rhino3dm();
const bytes = existsSync(options.file) ? readFileSync(options.file) : [];
const doc = rhino.File3dm.fromByteArray(new Uint8Array(bytes));
if (doc === null) {
    console.log(JSON.stringify({ readable: false }));
    process.exit(3);
}
const expected = options.points && JSON.parse(readFileSync(options.points, 'utf8'));
const objects = list(doc.objects()).map((object, i) => {
    const geometry = object.geometry(), attributes = object.attributes();
    if (!(geometry instanceof rhino.Brep)) return { type: geometry.constructor.name };
    return {
        id: attributes.id,
        layer: attributes.layerIndex,
        ...judgeBrep(geometry, attributes.name, expected?.objects[i].points),
    };
});
console.log(JSON.stringify({
    readable: true,
    archiveVersion: doc.archiveVersion,
    applicationName: doc.applicationName,
    units: doc.settings().modelUnitSystem.constructor.name.replace('UnitSystem_', ''),
    layers: list(doc.layers()).map((layer) => layer.name),
    objects,
}, undefined, 1));
