// The packed parts of the data: flight columns, search tree, aero map, triangles.

/** An error whose message is meant for the reader of the page. */
export class Trouble extends Error {}

/**
 * @param {string} base64
 * @param {string} what named in the message when it cannot be read
 * @param {"deflate"|"gzip"} format
 * @returns {Promise<ArrayBuffer>}
 */
export async function inflate(base64, what, format = "deflate") {
    if (typeof DecompressionStream === "undefined") {
        throw new Trouble(
            "This browser cannot unpack the data of the page: it lacks DecompressionStream. " +
            "Chromium 80, Firefox 113 and Safari 16.4 or newer have it.");
    }
    try {
        const text = atob(base64.trim());
        const bytes = new Uint8Array(text.length);
        for (let i = 0; i < text.length; ++i) {
            bytes[i] = text.charCodeAt(i);
        }
        const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format));
        return await new Response(stream).arrayBuffer();
    } catch (error) {
        throw new Trouble(`${what} of this page cannot be unpacked: the file is damaged (${error.message || error}).`);
    }
}

function expect_bytes(buffer, bytes, what) {
    if (buffer.byteLength !== bytes) {
        throw new Trouble(
            `${what} of this page has ${buffer.byteLength} bytes where ${bytes} belong: the file is damaged.`);
    }
}

/**
 * One column: bytes sorted by significance, each value XORed with the one before.
 * Done on halves of 32 bits, as BigInt would take most of the time the page needs to open.
 */
function unshuffle(source, offset, rows) {
    const bytes = new Uint8Array(8 * rows);
    for (let b = 0; b < 8; ++b) {
        const from = offset + b * rows;
        for (let i = 0; i < rows; ++i) {
            bytes[8 * i + b] = source[from + i];
        }
    }
    const halves = new Uint32Array(bytes.buffer);
    for (let i = 2; i < halves.length; ++i) {
        halves[i] ^= halves[i - 2];
    }
    return new Float64Array(bytes.buffer);
}

/**
 * @param {{rows: number, columns: string[], same_as: number[], data: string}} flight
 * @returns {Promise<Record<string, Float64Array>>} columns by name; equal columns share their array
 */
export async function decode_flight(flight) {
    const {rows, columns, same_as} = flight;
    const source = new Uint8Array(await inflate(flight.data, "The flight"));
    const stored = same_as.filter((other) => other < 0).length;
    expect_bytes(source.buffer, 8 * rows * stored, "The flight");
    const decoded = [];
    let offset = 0;
    columns.forEach((_, index) => {
        if (same_as[index] >= 0) {
            decoded.push(decoded[same_as[index]]);
            return;
        }
        decoded.push(unshuffle(source, offset, rows));
        offset += 8 * rows;
    });
    return Object.fromEntries(columns.map((name, index) => [name, decoded[index]]));
}

/**
 * @returns {Promise<{nodes: number, x_m: Float32Array, z_m: Float32Array, arm_rad: Float32Array, parent: Int32Array}>}
 */
export async function decode_tree(tree) {
    const n = tree.nodes;
    const buffer = await inflate(tree.data, "The search tree");
    expect_bytes(buffer, 16 * n, "The search tree");
    return {
        nodes: n,
        x_m: new Float32Array(buffer, 0, n),
        z_m: new Float32Array(buffer, 4 * n, n),
        arm_rad: new Float32Array(buffer, 8 * n, n),
        parent: new Int32Array(buffer, 12 * n, n),
    };
}

/** @returns {Promise<Uint8Array>} levels row by row from the lowest up */
export async function decode_map(map) {
    const buffer = await inflate(map.levels, "The aero map");
    expect_bytes(buffer, map.columns * map.rows, "The aero map");
    return new Uint8Array(buffer);
}

/** @returns {Promise<{vertices: Float32Array, indices: Uint32Array}>} */
export async function decode_triangles(triangles) {
    return {
        vertices: new Float32Array(await inflate(triangles.vertices, "A mesh")),
        indices: new Uint32Array(await inflate(triangles.indices, "A mesh")),
    };
}
