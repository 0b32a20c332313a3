// Memory of the browser: short values in localStorage, sites and the last plan in IndexedDB. Where neither is allowed, the
// page works and forgets.

export function remembered<T>(name: string, otherwise: T): T {
  try {
    const text = localStorage.getItem(`fieldhand.${name}`);
    return text === null ? otherwise : (JSON.parse(text) as T);
  } catch {
    return otherwise;
  }
}

export function remember(name: string, value: unknown): void {
  try {
    localStorage.setItem(`fieldhand.${name}`, JSON.stringify(value));
  } catch {
    // Full or forbidden: the value lives as long as the page.
  }
}

let opened: Promise<IDBDatabase> | null = null;

function database(): Promise<IDBDatabase> {
  opened ??= new Promise((resolve, reject) => {
    const request = indexedDB.open("fieldhand", 1);
    request.onupgradeneeded = () => request.result.createObjectStore("kept");
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
  return opened;
}

async function inStore<T>(mode: IDBTransactionMode, action: (store: IDBObjectStore) => IDBRequest<T>): Promise<T | undefined> {
  try {
    const store = (await database()).transaction("kept", mode).objectStore("kept");
    return await new Promise<T>((resolve, reject) => {
      const request = action(store);
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => reject(request.error);
    });
  } catch {
    return undefined;
  }
}

export const keep = (name: string, value: unknown): Promise<unknown> => inStore("readwrite", (store) => store.put(value, name));

export const kept = <T>(name: string): Promise<T | undefined> => inStore<T>("readonly", (store) => store.get(name));

export const forget = (name: string): Promise<unknown> => inStore("readwrite", (store) => store.delete(name));
