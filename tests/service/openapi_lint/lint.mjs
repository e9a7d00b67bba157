// node lint.mjs FILE: exits with 1 if the OpenAPI description breaks a rule.
import { createConfig, lintFromString } from "@redocly/openapi-core";
import { readFileSync } from "node:fs";

const config = await createConfig({
  extends: ["recommended-strict"],
  rules: {
    // The project has no license yet; the description is served by the server that it describes.
    "info-license": "off",
    "info-license-url": "off",
    "no-server-example.com": "off",
    "security-defined": "error",
    "operation-description": "off",
    "operation-operationId": "error",
    "operation-operationId-unique": "error",
    "operation-parameters-unique": "error",
    "operation-tag-defined": "error",
    "path-params-defined": "error",
    "tag-description": "off",
    "no-unused-components": "error",
  },
});
const file = process.argv[2];
const problems = await lintFromString({ source: readFileSync(file, "utf8"), absoluteRef: file, config });
for (const { ruleId, severity, message, location } of problems) {
  console.error(`${severity} ${ruleId} ${location[0]?.pointer ?? ""}: ${message}`);
}
process.exit(problems.length > 0 ? 1 : 0);
