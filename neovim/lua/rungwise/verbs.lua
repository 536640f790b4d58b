--- What `:Rungwise plc` and `:Rungwise simulate` have in common: verbs behind them, and commands of the server.
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

--- A function that has the server carry out the command `prefix .. verb` about the program of a buffer; its `done` gets
--- the answer. It gives a function that ends what goes on, and `over` is called when it is over, however that comes.
function M.teller(prefix)
  return function(buffer, verb, more, done, over)
    local server = client.expect(buffer)
    if not server then
      return
    end
    local argument = vim.tbl_extend('error', { uri = vim.uri_from_bufnr(buffer) }, more or {})
    local id = client.request(server, 'workspace/executeCommand', { command = prefix .. verb, arguments = { argument } },
      function(err, result)
        if over then
          over()
          over = nil
        end
        if err then
          client.notify(err.message or vim.inspect(err), vim.log.levels.ERROR)
        elseif done then
          done(result)
        end
      end, buffer)
    return function()
      client.cancel(server, id)
      -- Neovim drops the answer to a request that was cancelled.
      if over then
        over()
        over = nil
      end
    end
  end
end

--- The names of verbs, sorted.
function M.names(verbs)
  local names = vim.tbl_keys(verbs)
  table.sort(names)
  return names
end

--- Runs the verb that `words` begin with, or the `usual` one where they are none, about the buffer at hand.
function M.run(command, verbs, usual, words)
  local verb = verbs[words[1] or usual]
  if not verb then
    local text = t('there is no ":Rungwise %s %s"; there are %s', command, words[1], table.concat(M.names(verbs), ', '))
    client.notify(text, vim.log.levels.ERROR)
    return
  end
  verb(vim.api.nvim_get_current_buf(), vim.list_slice(words, 2))
end

return M
