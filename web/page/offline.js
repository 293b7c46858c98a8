// A service worker: the page works without a network once it has been there, in any folder of a server. What the network has goes first, so that a page that is there is never old.
// The build writes a hash of all files and the list of those that the page needs.
const OWN = `pantin ${self.registration.scope} `;
const CACHE = `${OWN}@BUILD@`;
const FILES = ["@FILES@"];
const here = (name) => new URL(name || "./", self.registration.scope).href;

self.addEventListener("install", (event) => {
  self.skipWaiting();
  const fill = async () => (await caches.open(CACHE)).addAll(FILES.map((name) => new Request(here(name), { cache: "no-cache" })));
  event.waitUntil(fill());
});

self.addEventListener("activate", (event) => {
  const old = async () => Promise.all((await caches.keys()).filter((name) => name.startsWith(OWN) && name !== CACHE).map((name) => caches.delete(name)));
  event.waitUntil(old().then(() => self.clients.claim()));
});

const kept = new Set(FILES.map(here));

async function answer(event, url) {
  const { request } = event;
  const cache = caches.open(CACHE);
  try {
    const response = await fetch(request);
    if (response.status !== 200 || kept.has(url)) return response;
    // A later file, such as the converter: it is kept once it was asked for.
    const copy = response.clone();
    event.waitUntil(cache.then((cache) => cache.put(url, copy)));
    return response;
  } catch (error) {
    const found = await (await cache).match(url, { ignoreVary: true });
    if (found) return found;
    throw error;
  }
}

self.addEventListener("fetch", (event) => {
  const { request } = event;
  // Of a file, whatever is asked about it: the page reads that itself.
  const { origin, pathname } = new URL(request.url);
  const url = origin + pathname.replace(/\/index\.html$/, "/");
  if (request.method === "GET" && url.startsWith(here("")) && !request.headers.has("range")) event.respondWith(answer(event, url));
});
