// Colours, light and canvas of the views in space.

import * as three from "three";

/** As in the scene: obstacles that the plane of motion cuts are darker than those beside it. */
export const palettes = {
    light: {
        paper: "#f7f8f9",
        section: "#d3d9df",
        projection: "#e4e9ee",
        edge: "#5d6770",
        vehicle: "#30363d",
        body: "#fbe0cb",
        flown: "#c2510a",
        planned: "#30363d",
        tip: "#00805e",
        goal: "#a3397a",
        force: "#0c4a8a",
        bad: "#b3261e"
    },
    dark: {
        paper: "#13171c",
        section: "#65717c",
        projection: "#343d46",
        edge: "#98a4ae",
        vehicle: "#dfe5ea",
        body: "#6b401f",
        flown: "#ff9b57",
        planned: "#dfe5ea",
        tip: "#3fd0a4",
        goal: "#f08cc8",
        force: "#a9d8ff",
        bad: "#ff8a80"
    },
};

export function lights() {
    const sun = new three.DirectionalLight(0xffffff, 0.25);
    sun.position.set(-8, -14, 10);
    return [new three.HemisphereLight(0xffffff, 0xb4bcc6, 0.85), sun];
}

export function make_canvas(renderer) {
    const canvas = renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute(
        "aria-label", "The scene and the flight in three dimensions; the numbers stand in the tables of this page.");
    return canvas;
}
