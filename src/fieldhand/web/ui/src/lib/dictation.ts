// Dictation by the browser, where it has it.

interface Recognition extends EventTarget {
  lang: string;
  continuous: boolean;
  interimResults: boolean;
  processLocally?: boolean;
  start(): void;
  stop(): void;
  onresult: ((event: { resultIndex: number; results: ArrayLike<ArrayLike<{ transcript: string }> & { isFinal: boolean }> }) => void) | null;
  onend: (() => void) | null;
  onerror: ((event: { error: string }) => void) | null;
}

type RecognitionClass = { new (): Recognition; available?: (options: object) => Promise<string> };

function recognitionClass(): RecognitionClass | null {
  const scope = window as unknown as { SpeechRecognition?: RecognitionClass; webkitSpeechRecognition?: RecognitionClass };
  return scope.SpeechRecognition ?? scope.webkitSpeechRecognition ?? null;
}

export const canDictate = (): boolean => recognitionClass() !== null;

export interface Dictation {
  stop(): void;
}

// Listens until it is stopped; `heard` takes each finished phrase. The words stay on the device if the browser can.
export async function dictate(lang: string, heard: (words: string) => void, ended: (error: string) => void): Promise<Dictation> {
  const Class = recognitionClass();
  if (!Class) throw new Error("no dictation");
  const recognition = new Class();
  recognition.lang = lang;
  recognition.continuous = true;
  const local = await Class.available?.({ langs: [lang], processLocally: true }).catch(() => "");
  if (local === "available") recognition.processLocally = true;
  let problem = "";
  recognition.onresult = ({ resultIndex, results }) => {
    for (let k = resultIndex; k < results.length; k++) {
      const result = results[k];
      if (result?.isFinal) heard((result[0]?.transcript ?? "").trim());
    }
  };
  recognition.onerror = ({ error }) => (problem = error);
  recognition.onend = () => ended(problem);
  recognition.start();
  return recognition;
}
