import { useEffect, useRef, useState } from 'preact/hooks';
import { ApiError, signIn } from '../api/client';

/** A dialog over the page: what was entered below it stays. */
export function SignIn() {
  const dialog = useRef<HTMLDialogElement>(null);
  const field = useRef<HTMLInputElement>(null);
  const [problem, setProblem] = useState('');
  useEffect(() => dialog.current!.showModal(), []);
  const submit = async (event: SubmitEvent) => {
    event.preventDefault();
    const token = field.current!.value.trim();
    if (token === '') return setProblem('Enter a token.');
    try {
      await signIn(token);
    } catch (error) {
      const refused = error instanceof ApiError && error.status === 401;
      setProblem(refused ? 'The token is unknown, has expired or was revoked.' : (error as Error).message);
      field.current!.select();
    }
  };
  return (
    <dialog ref={dialog} class="sign-in" aria-labelledby="sign-in-title" onCancel={(event) => event.preventDefault()}>
      <form onSubmit={(event) => void submit(event)}>
        <h1 id="sign-in-title">Sign in</h1>
        <p class="muted">
          The server wrote the owner's token beside its database (<code>DATABASE.token</code>);
          <code> tribodynd tokens create NAME</code> makes others.
        </p>
        <label>
          Token
          <input ref={field} type="password" autocomplete="off" spellcheck={false} autofocus
            aria-invalid={problem !== ''} aria-describedby="sign-in-problem" />
        </label>
        <p id="sign-in-problem" class="problem" role="alert">{problem}</p>
        <button class="primary">Sign in</button>
      </form>
    </dialog>
  );
}
