"use client";
// React renders the element in the browser: a server has no custom elements.
export * from "./pantin-player.js";
