// `import "@pantin/player/react"` defines the element, and lets JSX of React 18 and 19 have it. Listeners in JSX need React 19.
import type { DetailedHTMLProps, HTMLAttributes } from "react";
import type { PantinPlayer, PantinPlayerAttributes, PantinPlayerListeners } from "@pantin/player";

export * from "@pantin/player";

type Own = PantinPlayerAttributes & PantinPlayerListeners;

declare module "react" {
  namespace JSX {
    interface IntrinsicElements {
      "pantin-player": Omit<DetailedHTMLProps<HTMLAttributes<PantinPlayer>, PantinPlayer>, keyof Own> & Own & { class?: string };
    }
  }
}
