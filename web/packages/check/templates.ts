// What templates of Vue and Svelte may write, by the types that their checkers read.
import "@pantin/player/svelte";
import "@pantin/player/vue";
import type { SvelteHTMLElements } from "svelte/elements";
import type { GlobalComponents } from "vue";

type Vue = InstanceType<GlobalComponents["pantin-player"]>["$props"];
type Svelte = SvelteHTMLElements["pantin-player"];

export const vue: Vue = { src: "walk.ptn", look: "solid", class: ["hero", { wide: true }], onHeard: ({ detail }) => console.log(detail.frame), onClick: ({ clientX }) => console.log(clientX) };
export const svelte: Svelte = { src: "walk.ptn", loading: "lazy", class: "hero", onheard: ({ detail }) => console.log(detail.frame), onclick: ({ clientX }) => console.log(clientX) };
// @ts-expect-error There is no such attribute value.
export const wrong: Svelte = { fit: "half" };
// @ts-expect-error There is no such attribute value.
export const bad: Vue = { align: "middle" };
