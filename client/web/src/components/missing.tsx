import { address } from '../router';

/** The same page for what does not exist and for what another project has. */
export function Missing() {
  return (
    <section class="empty">
      <h1>Nothing is here</h1>
      <p>The address is wrong, what it names was deleted, or it belongs to a project that your token is not for.</p>
      <a class="button" href={address('/')}>Home</a>
    </section>
  );
}
