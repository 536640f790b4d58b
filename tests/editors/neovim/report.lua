-- Counts checks and prints them in the one form that run.sh reads.
local M = { passed = 0, failed = 0 }

--- Runs one named check; one that raises an error has failed, the next ones still run.
function M.check(name, body)
  local start = vim.uv.hrtime()
  local ok, reason = xpcall(body, function(message)
    return debug.traceback(tostring(message), 2)
  end)
  if ok then
    M.passed = M.passed + 1
    io.write(('ok      %s (%d ms)\n'):format(name, (vim.uv.hrtime() - start) / 1e6))
  else
    M.failed = M.failed + 1
    io.write(('FAILED  %s: %s\n'):format(name, reason))
  end
  io.flush()
end

--- Prints the summary line and ends Neovim with the exit code.
function M.finish()
  io.write(('%d passed, %d failed\n'):format(M.passed, M.failed))
  io.flush()
  for _, client in ipairs(vim.lsp.get_clients()) do
    client:stop(true)
  end
  vim.cmd(M.failed == 0 and M.passed > 0 and 'qall!' or 'cquit')
end

return M
